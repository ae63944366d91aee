// SPDX-License-Identifier: Apache-2.0
// The lower half of the page: how accurate, how fast, and what else happened.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "onboard/report/page/html_sections.hpp"
#include "onboard/report/page/html_text.hpp"
#include "onboard/report/page/svg_chart.hpp"

namespace cairn::report::html {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

std::string row(const std::string& name, const std::string& value) {
  return fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", name, value);
}

std::string percent(const std::optional<double>& share) { return share ? number(100 * *share) + " %" : "–"; }

/// Lengths in cm or, where an error gets large, in m; angles in degrees.
struct Unit {
  double factor;
  const char* name;
};

Unit unit_of(const std::vector<PoseError>& errors, Eigen::Index axis) {
  if (axis >= 3) return {kDegrees, "° over s"};
  double largest = 0;
  for (const PoseError& e : errors) largest = std::max(largest, e.distance_m);
  return largest < 2 ? Unit{100, "cm over s"} : Unit{1, "m over s"};
}

/// Error along one axis of base_link with the 3 σ that the estimate claims.
std::string axis_chart(const RunReport& report, const Accuracy& accuracy, Eigen::Index axis, const char* title) {
  const Unit unit = unit_of(accuracy.pose_errors, axis);
  LineChart chart{title, unit.name, {{"path", {}, {}}}, {}, false};
  bool claimed = false;
  for (const PoseError& e : accuracy.pose_errors) {
    chart.curves[0].x.push_back(to_seconds(e.stamp - report.start));
    chart.curves[0].y.push_back(unit.factor * e.error(axis));
    chart.band.x.push_back(chart.curves[0].x.back());
    chart.band.half.push_back(unit.factor * 3 * e.sigma(axis));
    claimed = claimed || e.sigma(axis) > 0;
  }
  if (!claimed) chart.band = {};
  return svg(chart);
}

std::string distance_chart(const RunReport& report, const Accuracy& accuracy) {
  const Unit unit = unit_of(accuracy.pose_errors, 0);
  LineChart chart{"Position error", unit.name, {{"path", {}, {}}}, {}, true};
  for (const PoseError& e : accuracy.pose_errors) {
    chart.curves[0].x.push_back(to_seconds(e.stamp - report.start));
    chart.curves[0].y.push_back(unit.factor * e.distance_m);
  }
  return svg(chart);
}

std::string error_table(const TrajectoryError& e, std::span<const PoseError> errors) {
  std::string s = "<div class=\"pair\"><table>\n";
  s += row("ATE, least squares", length(e.ate_se3_rmse_m));
  s += row("ATE, first poses aligned", length(e.ate_first_rmse_m));
  s += row("at the end", length(e.final_error_m));
  s += row("length of the ground truth", length(e.length_m));
  s += "</table><table>\n";
  if (e.segments) {
    s += row("relative error", number(e.segments->trans_percent) + " %");
    s += row("relative rotation", number(e.segments->rot_deg_per_m) + " °/m");
  }
  if (e.steps) s += row("pose to pose", number(e.steps->trans_percent) + " %");
  const auto inside = share_inside_3_sigma(errors);
  s += row("inside 3 σ along x, y, z", percent(inside[0]) + ", " + percent(inside[1]) + ", " + percent(inside[2]));
  s += row("inside 3 σ in yaw", percent(inside[5]));
  return s + "</table></div>\n";
}

std::string stage_row(const StageStats& s) {
  const auto ms = [](Duration d) { return number(to_milliseconds(d)); };
  if (s.wall.count() == 0)
    return fmt::format("<tr><td class=\"l\">{}</td><td>0</td><td colspan=\"8\">{}</td></tr>\n", escape(s.name),
                       kNotMeasured);
  const bool over = s.budget > Duration{} && s.wall.percentile(0.99) > s.budget;
  return fmt::format(
      "<tr><td class=\"l\">{}</td><td>{}</td><td>{}</td><td>{}</td><td "
      "class=\"{}\">{}</td><td>{}</td><td>{}</td><td>{}</td>"
      "<td>{}</td><td class=\"{}\">{}</td></tr>\n",
      escape(s.name), count(s.wall.count()), ms(s.wall.mean()), ms(s.wall.percentile(0.5)), over ? "bad" : "",
      ms(s.wall.percentile(0.99)), ms(s.wall.percentile(0.999)), ms(s.wall.max()),
      s.cpu.count() > 0 ? ms(s.cpu.percentile(0.5)) : "–", s.budget > Duration{} ? ms(s.budget) : "–",
      s.overruns > 0 ? "warn" : "", count(s.overruns));
}

std::string pose_cells(const std::optional<UncertainPose>& T_map_peer) {
  if (!T_map_peer) return "<td colspan=\"2\">not known</td>";
  const Vector6 pose = T_map_peer->mean.xyz_rpy();
  return fmt::format("<td>{:.2f}, {:.2f}, {:.2f}</td><td>{:.1f}</td>", pose(0), pose(1), pose(2), kDegrees * pose(5));
}

}  // namespace

std::string accuracy_section(const RunReport& report, const Accuracy& accuracy) {
  if (!accuracy.error || accuracy.pose_errors.empty()) return {};
  std::string s = "<section><h2>Accuracy</h2>\n" + error_table(*accuracy.error, accuracy.pose_errors);
  s += "<div class=\"key\"><span><i></i>error, first poses laid over each other, axes of the robot</span>"
       "<span><i class=\"band\"></i>claimed 3 σ</span></div><div class=\"charts\">\n";
  s += distance_chart(report, accuracy);
  s += axis_chart(report, accuracy, 5, "Heading");
  s += axis_chart(report, accuracy, 0, "Ahead (x)");
  s += axis_chart(report, accuracy, 1, "To the left (y)");
  s += axis_chart(report, accuracy, 2, "Up (z)");
  s += axis_chart(report, accuracy, 4, "Pitch");
  return s + "</div></section>\n";
}

std::string timing_section(const RunReport& report) {
  if (report.monitor == nullptr || report.monitor->stages().empty()) return {};
  std::string s =
      "<section><h2>Timing</h2><div class=\"scroll\"><table>\n<tr><th class=\"l\">stage</th><th>runs</th><th>mean "
      "ms</th>"
      "<th>p50</th><th>p99</th><th>p99.9</th><th>max</th><th>CPU p50</th><th>budget</th><th>overruns</th></tr>\n";
  for (const StageStats& stage : report.monitor->stages()) s += stage_row(stage);
  s += "</table></div><div class=\"charts\">\n";
  const Decades decades = decades_of(*report.monitor);
  for (const StageStats& stage : report.monitor->stages())
    if (stage.wall.count() > 0) s += svg_histogram(stage, decades);
  s += "</div><div class=\"key\"><span><i class=\"bars\"></i>elapsed time</span><span><i class=\"cpu\"></i>CPU "
       "time</span>"
       "<span><i class=\"p99\"></i>99 % are faster</span><span><i class=\"budget\"></i>budget</span></div>\n";
  return s + "</section>\n";
}

std::string events_section(const RunReport& report) {
  if (report.monitor == nullptr || report.monitor->events().empty()) return {};
  std::string s =
      "<section><h2>Events and faults</h2><div class=\"scroll\"><table>\n<tr><th class=\"l\">first</th><th "
      "class=\"l\">last</th>"
      "<th class=\"l\">stage</th><th class=\"l\">what</th><th>times</th></tr>\n";
  for (const Event& e : report.monitor->events())
    s += fmt::format(
        "<tr><td class=\"l\">{:.3f} s</td><td class=\"l\">{:.3f} s</td><td class=\"l\">{}</td>"
        "<td class=\"l w\">{}</td><td>{}</td></tr>\n",
        to_seconds(e.first - report.start), to_seconds(e.last - report.start), escape(e.stage), escape(e.what),
        count(e.count));
  return s + "</table></div></section>\n";
}

std::string peers_section(const RunReport& report) {
  if (report.peers.empty()) return {};
  std::string s =
      "<section><h2>Peers</h2><div class=\"scroll\"><table>\n<tr><th "
      "class=\"l\">robot</th><th>sent</th><th>received</th>"
      "<th>tiles</th><th>age p99 s</th><th>x, y, z m</th><th>yaw °</th><th class=\"l\">merged</th></tr>\n";
  for (const auto& [name, p] : report.peers) {
    s += fmt::format(
        "<tr><td class=\"l\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>{}<td class=\"l w {}\">{}</td></tr>\n",
        escape(name), bytes(static_cast<double>(p.tx_bytes)), bytes(static_cast<double>(p.rx_bytes)), count(p.tiles),
        measured(p.age_p99_s, number), pose_cells(p.T_map_peer), p.accepted ? "good" : "warn",
        p.accepted ? "yes" : "no: " + escape(p.reason));
  }
  return s + "</table></div></section>\n";
}

std::string details_section(const RunReport& report) {
  const auto late = [](Duration d) { return number(1e-3 * static_cast<double>(d.count())) + " µs late"; };
  const MapSummary& map = report.map;
  std::string s = "<section><h2>Details</h2><div class=\"pair\"><table>\n";
  s +=
      row("occupied, free, labelled voxels", count(map.occupied) + ", " + count(map.free) + ", " + count(map.labelled));
  if (report.cleared_voxels > 0) s += row("voxels cleared of what came and went", count(report.cleared_voxels));
  s += row("known volume", number(map.known_volume_m3()) + " m³");
  s += row("map in memory", bytes(static_cast<double>(map.memory_bytes)));
  if (report.map_file_bytes) s += row("map.cairn", bytes(static_cast<double>(*report.map_file_bytes)));
  if (map.mean_entropy_occupancy)
    s += row("mean entropy of occupied voxels", number(*map.mean_entropy_occupancy) + " bit");
  s += "</table><table>\n";
  s += row("iterations per scan", measured(report.odometry.mean_iterations, number));
  s +=
      row("degenerate, lost scans", count(report.odometry.degenerate_scans) + ", " + count(report.odometry.lost_scans));
  s += row("latest tick", measured(report.ticks.max_lateness, late));
  s += row("allocations on the control thread", measured(report.control_thread_allocations, count));
  s += row("version", escape(report.version));
  s += "</table></div></section>\n";
  if (!report.effective_config.empty())
    s += "<section><details><summary>Effective configuration</summary><pre>" + escape(report.effective_config) +
         "</pre></details></section>\n";
  return s;
}

}  // namespace cairn::report::html
