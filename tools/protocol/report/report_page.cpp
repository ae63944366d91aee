// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tools/protocol/report/claims.hpp"
#include "tools/protocol/report/page_parts.hpp"
#include "tools/protocol/report/plot.hpp"
#include "tools/protocol/report/report.hpp"
#include "tools/protocol/report/tables.hpp"

namespace cairn::protocol {
namespace {

std::size_t colour_of(std::string_view method) {
  const auto all = table_methods();
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), method) - all.begin());
}

template <class Value>
std::string boxes_of(const PairOutcome& scene, const Axis& axis, const Value& value) {
  std::vector<NamedBox> boxes;
  for (const std::string_view method : table_methods()) {
    const MethodRun* run = scene.run(method);
    if (run == nullptr || run->attempts.empty()) continue;
    std::vector<double> values;
    for (const Attempt& a : run->attempts) values.push_back(value(a));
    boxes.push_back({std::string(method), colour_of(method), box_of(values)});  // titles are too long to stand below
  }
  return box_plot(axis, boxes);
}

std::string error_boxes(const Outcome& outcome) {
  std::string figures;
  for (const PairOutcome* scene : outcome.of_kind(kScene)) {
    figures += figure(scene->pair.name + ", error in position",
                      boxes_of(*scene, {"m", 0.001, 10, true}, [](const Attempt& a) { return a.error.m; }));
    figures += figure(scene->pair.name + ", error in heading and tilt",
                      boxes_of(*scene, {"°", 0.01, 100, true}, [](const Attempt& a) { return a.error.deg; }));
  }
  return charts_section(
      "Errors from all starts (book: Fig. 4.11)", figures,
      "<p class=\"note\">Box: middle half of the starts, line: median, diamond: mean, whiskers: within 1.5 "
      "box heights, dots: beyond. Logarithmic; what is smaller or larger stands at the edge.</p>");
}

std::string success_curves(const Outcome& outcome) {
  std::string figures;
  std::vector<Line> names;
  for (const PairOutcome* scene : outcome.of_kind(kScene)) {
    std::vector<Line> lines;
    for (const std::string_view method : table_methods()) {
      const MethodRun* run = scene->run(method);
      if (run == nullptr) continue;
      Line line{std::string(title_of(method)), colour_of(method), {}, {}};
      for (const SuccessAt& s : success_by_distance(run->attempts)) {
        line.x.push_back(s.distance_m);
        line.y.push_back(100 * s.success);
      }
      lines.push_back(std::move(line));
    }
    if (lines.size() > names.size()) names = lines;
    figures += figure(scene->pair.name, line_plot({"distance of the start, m", 0, 3, false},
                                                  {"success, %", 0, 100, false}, {0, 0.5, 1, 1.5, 2, 2.5, 3}, lines));
  }
  return charts_section("Success against the start's offset (book: Fig. 4.12)", figures, legend(names));
}

/// By scene, of each method the points (overlap, y).
template <class Value>
std::map<std::string, std::vector<Line>> overlap_lines(const Outcome& outcome, const Value& value) {
  std::map<std::string, std::vector<Line>> lines;
  const auto pairs = outcome.by_falling_overlap();
  for (const std::string_view method : table_methods()) {
    std::map<std::string, Line> by_scene;
    for (const PairOutcome* p : pairs) {
      const MethodRun* run = p->run(method);
      if (run == nullptr) continue;
      Line& line = by_scene[p->pair.scene];
      line.x.push_back(100 * p->pair.overlap);
      line.y.push_back(value(figures_of(run->attempts)));
    }
    for (auto& [scene, line] : by_scene) {
      line.name = title_of(method);
      line.colour = colour_of(method);
      lines[scene].push_back(std::move(line));
    }
  }
  return lines;
}

std::string overlap_curves(const Outcome& outcome) {
  std::string figures;
  std::vector<Line> names;
  const Axis x{"overlap, %", 46, 9, false};  // falls from left to right, as the book draws it
  const std::vector<double> marks{45, 40, 35, 30, 25, 20, 15, 10};
  const auto errors = overlap_lines(outcome, [](const Figures& f) { return f.mean_error_m; });
  const auto successes = overlap_lines(outcome, [](const Figures& f) { return 100 * f.success; });
  for (const auto& [scene, lines] : errors) {
    figures += figure(scene + ", mean error, at most 4 m", line_plot(x, {"m", 0, 4, false}, marks, lines));
    figures += figure(scene + ", success", line_plot(x, {"%", 0, 100, false}, marks, successes.at(scene)));
    names = lines;
  }
  return charts_section("Less and less overlap (book: Fig. 4.10)", figures, legend(names));
}

std::vector<Claim> claims_by(const Outcome& outcome, bool books) {
  auto claims = claims_of(outcome);
  std::erase_if(claims, [&](const Claim& c) { return c.books != books; });
  return claims;
}

}  // namespace

std::string to_page(const Outcome& outcome) {
  std::string page = page_head(
      "Map matching: the protocol", "Map matching: the book's protocol",
      fmt::format("Yue &amp; Wang, Collaborative Perception, Localization and Mapping for Autonomous Systems, ch. 3 to "
                  "5; 125 starts: x and y ±2 m by 1 m, yaw ±15° by 7.5°. Seed {}.",
                  outcome.seed));
  page += claims_section("What is asked of Cairn", claims_by(outcome, false)) +
          claims_section("What the book says", claims_by(outcome, true));
  const auto tables = all_tables(outcome);
  for (std::size_t i = 0; i < 5; ++i) page += to_html(tables[i]);
  page += error_boxes(outcome) + success_curves(outcome);
  for (std::size_t i = 5; i < tables.size(); ++i) page += to_html(tables[i]);
  page += overlap_curves(outcome);
  return page + page_end(
                    "Maps: recordings of the simulator, points placed by the true poses, Cairn's mapping at 0.1 m; cut "
                    "across the building to the overlap. PCL 1.13: pairs within 2 m, at most 30 iterations, otherwise "
                    "its defaults. CPU time of one thread.");
}

}  // namespace cairn::protocol
