// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/json/json_values.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::report {

Json to_json(const ClassCounts& counts) {
  Json json = Json::object();
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) json[std::string(kSemanticClasses[i].name)] = counts[i];
  return json;
}

Json to_json(const LabelError& e) {
  Json by_class = Json::object(), voxels = Json::object();
  for (std::size_t i = 0; i < kClasses; ++i) {
    if (e.confusion.voxels_of(i) == 0) continue;
    by_class[std::string(kSemanticClasses[i].name)] = or_null(e.confusion.iou(i));
    voxels[std::string(kSemanticClasses[i].name)] = e.confusion.voxels_of(i);
  }
  return {{"label_accuracy", or_null(e.confusion.agreement())},
          {"miou", or_null(e.confusion.miou(kMinTrueVoxels))},
          {"iou_by_class", std::move(by_class)},
          {"true_voxels_by_class", std::move(voxels)},
          {"label_tolerance_m", e.tolerance_m},
          {"label_common", e.common},
          {"labelled_share", or_null(e.labelled_share())}};
}

Json to_json(const MapSummary& map) {
  return {{"resolution_m", map.resolution_m},
          {"occupied", map.occupied},
          {"free", map.free},
          {"labelled", map.labelled},
          {"classes", to_json(map.by_class)},
          {"nodes", map.nodes},
          {"leaves", map.leaves},
          {"memory_bytes", map.memory_bytes},
          {"known_volume_m3", map.known_volume_m3()},
          {"min_m", numbers(map.min_m)},
          {"max_m", numbers(map.max_m)},
          {"mean_entropy_occupancy", or_null(map.mean_entropy_occupancy)},
          {"mean_entropy_book", or_null(map.mean_entropy_book)},
          {"mean_entropy_known", or_null(map.mean_entropy_known)},
          {"mean_entropy_label", or_null(map.mean_entropy_label)}};
}

Json to_json(const mapping::PositionFigures& f) {
  return {{"voxels", f.voxels},
          {"shared", f.shared},
          {"mean_m", f.mean_m},
          {"p95_m", f.p95_m},
          {"shared_mean_m", f.shared_mean_m},
          {"shared_alone_m", f.shared_alone_m}};
}

Json to_json(const MapComparison& c) {
  return {{"same", c.same},
          {"disagreeing", c.disagreeing},
          {"only_a", c.only_a},
          {"only_b", c.only_b},
          {"iou_occupied", or_null(c.iou_occupied())},
          {"occupied_a", c.occupied_a},
          {"occupied_b", c.occupied_b},
          {"occupied_both", c.occupied_both},
          {"free_a", c.free_a},
          {"free_b", c.free_b},
          {"differing_log_odds", c.differing_log_odds},
          {"labelled_both", c.labels.total()},
          {"label_agreement", or_null(c.labels.agreement())},
          {"miou", or_null(c.labels.miou(0))}};
}

Json to_json(const MapError& e) {
  return {{"accuracy_mean_m", e.mean_m},
          {"accuracy_rmse_m", e.rmse_m},
          {"precision", or_null(e.precision())},
          {"recall", or_null(e.recall())},
          {"occupied", e.occupied},
          {"correct", e.correct},
          {"true_occupied", e.true_occupied},
          {"found", e.found},
          {"contradicted", e.contradicted},
          {"unseen", e.unseen}};
}

}  // namespace cairn::report
