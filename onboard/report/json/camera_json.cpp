// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/json/camera_json.hpp"

#include <nlohmann/json.hpp>

namespace cairn::report {

nlohmann::json labels_json(const RunReport& report) {
  if (!report.labels) return nullptr;
  const LabelStats& l = *report.labels;
  return {{"images", l.images},
          {"points", l.points},
          {"voxels", l.voxels},
          {"latency_p99_ms", l.latency_p99_ms ? nlohmann::json(*l.latency_p99_ms) : nlohmann::json(nullptr)},
          {"passed", l.passed},
          {"shed", l.shed},
          {"refused", l.refused},
          {"apart", l.apart}};
}

nlohmann::json visual_odometry_json(const RunReport& report) {
  if (!report.visual_odometry) return nullptr;
  const VisualStats& v = *report.visual_odometry;
  return {{"frames", v.frames},   {"tracked", v.tracked}, {"lost", v.lost},
          {"refused", v.refused}, {"clouds", v.clouds},   {"points", v.points}};
}

nlohmann::json depth_json(const RunReport& report) {
  if (!report.depth) return nullptr;
  const DepthStats& d = *report.depth;
  return {{"images", d.images}, {"points", d.points}, {"passed", d.passed}, {"refused", d.refused}, {"apart", d.apart}};
}

namespace {

nlohmann::json detector_json(const std::optional<DetectorStats>& d) {
  if (!d) return nullptr;
  return {{"images", d->images},
          {"passed", d->passed},
          {"shed", d->shed},
          {"refused", d->refused},
          {"correcting", d->correcting},
          {"offset_deg", d->offset_deg ? nlohmann::json(*d->offset_deg) : nlohmann::json(nullptr)}};
}

}  // namespace

nlohmann::json people_json(const RunReport& report) {
  if (!report.people) return nullptr;
  const PeopleStats& p = *report.people;
  return {{"tracks", p.tracks},
          {"detections_visible", p.visible ? nlohmann::json(p.visible->detections) : nlohmann::json(nullptr)},
          {"detections_thermal", p.thermal ? nlohmann::json(p.thermal->detections) : nlohmann::json(nullptr)},
          {"visible", detector_json(p.visible)},
          {"thermal", detector_json(p.thermal)},
          {"apart", p.apart},
          {"most_at_once", p.most_at_once},
          {"nearest_m", p.nearest_m ? nlohmann::json(*p.nearest_m) : nlohmann::json(nullptr)}};
}

nlohmann::json mounts_json(const RunReport& report) {
  const auto three = [](const std::optional<Eigen::Vector3d>& v) {
    return v ? nlohmann::json({v->x(), v->y(), v->z()}) : nlohmann::json(nullptr);
  };
  nlohmann::json all = nlohmann::json::array();
  for (const MountStats& m : report.mounts)
    all.push_back({{"camera", m.camera},
                   {"images", m.images},
                   {"pairs", m.pairs},
                   {"passed", m.passed},
                   {"shed", m.shed},
                   {"refused", m.refused},
                   {"turn_deg", three(m.turn_deg)},
                   {"deviation_deg", three(m.deviation_deg)},
                   {"moved", m.moved}});
  return all;
}

}  // namespace cairn::report
