// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/unlike/unlike_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "hal/files/file.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "tools/protocol/report/page_parts.hpp"
#include "tools/protocol/report/plot.hpp"
#include "tools/protocol/unlike/label_tables.hpp"
#include "tools/protocol/unlike/unlike_tables.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

/// y of each fusion of a scene.
template <class Value>
Line line_of(const std::vector<UnlikeOutcome>& all, const std::string& scene, std::string name, std::size_t colour,
             const Value& value) {
  Line line{std::move(name), colour, {}, {}};
  for (const UnlikeOutcome* o : fusions_of(all, scene)) {
    line.x.push_back(o->moment.fusion);
    line.y.push_back(value(*o));
  }
  return line;
}

double greatest(const std::vector<Line>& lines) {
  double most = 0;
  for (const Line& line : lines)
    for (const double y : line.y) most = std::max(most, y);
  return most;
}

std::vector<double> marks_of(const std::vector<Line>& lines) {
  return lines.empty() ? std::vector<double>() : lines.front().x;
}

std::string correspondences_curves(const std::vector<UnlikeOutcome>& all) {
  constexpr double kBookMost = 4;  // the book's axis
  std::string figures;
  for (const std::string& scene : scenes_of(all)) {
    const Line line = line_of(all, scene, scene, 8, [](const UnlikeOutcome& o) {
      const MethodRun* em = o.outcome.run("em");
      return em != nullptr ? em->correspondences.value_or(1) : 1;
    });
    const double last = line.x.empty() ? 1 : line.x.back();
    figures += figure(scene, line_plot({"fusion", 0, last, false},
                                       {"voxels", 0, std::max(kBookMost, greatest({line})), false}, line.x, {line}));
  }
  return charts_section("Voxels with which EM pairs a voxel of the sparser map, mean (book: Fig. 5.13)", figures);
}

std::string time_curves(const std::vector<UnlikeOutcome>& all) {
  struct Titled {
    const char* method;
    std::size_t colour;
  };
  std::string figures;
  std::vector<Line> lines;
  for (const std::string& scene : scenes_of(all)) {
    lines.clear();
    for (const Titled& t : {Titled{"oicp", 4}, Titled{"em_book", 6}, Titled{"em", 8}, Titled{"default", 9}})
      lines.push_back(line_of(all, scene, std::string(title_of(t.method)), t.colour,
                              [&](const UnlikeOutcome& o) { return o.seconds(t.method); }));
    const double last = lines.front().x.empty() ? 1 : lines.front().x.back();
    figures +=
        figure(scene, line_plot({"fusion", 0, last, false}, {"s", 0, greatest(lines), false}, marks_of(lines), lines));
  }
  return charts_section("CPU time of a fusion (book: Fig. 5.14)", figures, legend(lines));
}

std::string pictures_section(const std::vector<UnlikeOutcome>& all) {
  std::string figures;
  for (const UnlikeOutcome& o : all)
    for (const NamedPicture& p : o.pictures) figures += picture(p.title, p.png);
  return figures.empty() ? figures
                         : charts_section("The maps at the end, by class (book: Figs. 7.10 and 7.11)", figures);
}

Json to_json(const Entropies& e) {
  return {{"occupied", e.occupied}, {"labelled", e.labelled}, {"occupancy", e.occupancy},
          {"book", e.book},         {"label", e.label},       {"overall", e.overall()}};
}

Json to_json(const EntropiesOfThree& e) {
  return {{"ugv", to_json(e.a)}, {"uav", to_json(e.b)}, {"fused", to_json(e.fused)}};
}

Json to_json(const UnlikeOutcome& o) {
  const MapPair& p = o.outcome.pair;
  Json json = {{"scene", o.scene()},           {"fusion", o.moment.fusion},        {"seconds", o.moment.seconds},
               {"voxels_a", p.voxels_a},       {"voxels_b", p.voxels_b},           {"overlap", p.overlap},
               {"error_m", o.attempt.error.m}, {"error_deg", o.attempt.error.deg}, {"accepted", o.attempt.accepted},
               {"merge_s", o.merge_s},         {"methods", Json::array()}};
  for (const MethodRun& run : o.outcome.runs) {
    const Figures f = figures_of(run.attempts);
    Json method = {{"method", run.method},
                   {"rms_m", f.rms_m},
                   {"success", f.success},
                   {"starts", f.starts},
                   {"seconds", o.seconds(run.method)}};
    if (run.correspondences) method["correspondences"] = *run.correspondences;
    json["methods"].push_back(std::move(method));
  }
  return json;
}

Json labels_json() {
  Json rows = Json::array();
  for (const FusedLabelRow& row : fused_label_rows())
    rows.push_back({{"table", row.book.table},
                    {"book", row.book.fused_p},
                    {"evenly", row.evenly},
                    {"share", row.share ? Json(*row.share) : Json(nullptr)},
                    {"with_share", row.with_share}});
  return rows;
}

std::vector<Claim> claims_by(const std::vector<UnlikeOutcome>& all, bool books) {
  auto claims = unlike_claims(all);
  std::erase_if(claims, [&](const Claim& c) { return c.books != books; });
  return claims;
}

}  // namespace

Json unlike_json(const std::vector<UnlikeOutcome>& all, unsigned seed) {
  Json json = {{"seed", seed},
               {"fusions", Json::array()},
               {"entropies", Json::array()},
               {"labels", labels_json()},
               {"claims", Json::array()}};
  for (const UnlikeOutcome& o : all) {
    json["fusions"].push_back(to_json(o));
    if (o.entropies)
      json["entropies"].push_back({{"scene", o.scene()},
                                   {"whole", to_json(o.entropies->whole)},
                                   {"shared", to_json(o.entropies->shared)},
                                   {"told", to_json(o.entropies->told)}});
  }
  for (const Claim& c : unlike_claims(all))
    json["claims"].push_back(
        {{"claim", c.claim}, {"of", c.books ? "book" : "Cairn"}, {"figures", c.figures}, {"holds", c.holds}});
  return json;
}

std::string unlike_page(const std::vector<UnlikeOutcome>& all, unsigned seed) {
  std::string page = page_head(
      "Unlike robots: the protocol", "A UGV with a LiDAR and a UAV with a stereo camera",
      fmt::format(
          "Yue &amp; Wang, Collaborative Perception, Localization and Mapping for Autonomous Systems, ch. 5 and "
          "7; simulated drives and flights. Seed {}, flights {}.",
          seed, seed + 1));
  page += claims_section("What is asked of Cairn", claims_by(all, false)) +
          claims_section("What the book says", claims_by(all, true));
  page +=
      to_html(fused_table(all)) + to_html(shared_table(all)) + to_html(told_table(all)) + to_html(label_rows_table());
  page += pictures_section(all);
  page += to_html(unlike_rms_table(all)) + correspondences_curves(all) + time_curves(all) + to_html(fusions_table(all));
  return page + page_end(
                    "Maps: Cairn's runs at 0.2 m, with its own odometry and segmentation network. They are fused "
                    "where the default method finds that they lie, from the true pose. Other starts: x and y ±2 m, yaw "
                    "±15° around it.");
}

Result<void> write_unlike(const fs::path& pairs, unsigned seed, const fs::path& out) {
  const auto all = load_unlike(pairs);
  if (!all) return all.error();
  for (const Table& table : unlike_tables(*all)) std::cout << to_text(table);
  std::cout << to_text(unlike_claims(*all));
  for (const UnlikeOutcome& o : *all)
    if (o.map != nullptr)
      if (auto saved = mapping::save_cairn(*o.map, out / (o.scene() + "_fused.cairn")); !saved) return saved;
  if (auto written = write_file_atomic(out / "unlike.json", unlike_json(*all, seed).dump(1) + '\n'); !written)
    return written;
  return write_file_atomic(out / "unlike.html", unlike_page(*all, seed));
}

}  // namespace cairn::protocol
