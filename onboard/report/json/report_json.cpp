// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/json/report_json.hpp"

#include <nlohmann/json.hpp>

#include "onboard/report/figures/accuracy.hpp"
#include "onboard/report/json/camera_json.hpp"
#include "onboard/report/json/json_values.hpp"
#include "onboard/report/notes/notes.hpp"

namespace cairn::report {
namespace {

/// A figure of a run that measured it.
template <class T>
Json if_measured(bool measured, const T& value) {
  return measured ? Json(value) : Json(nullptr);
}

void add_percentiles(Json& stage, const std::string& prefix, const Histogram& times) {
  const auto add = [&](const char* name, Duration time) {
    stage[prefix + name] = if_measured(times.count() > 0, to_milliseconds(time));
  };
  add("mean_ms", times.mean());
  add("p50_ms", times.percentile(0.5));
  add("p99_ms", times.percentile(0.99));
  add("p999_ms", times.percentile(0.999));
  add("max_ms", times.max());
}

Json stage_json(const StageStats& stats) {
  Json stage{{"count", stats.wall.count()}};
  add_percentiles(stage, "", stats.wall);
  stage["budget_ms"] = stats.budget > Duration{} ? Json(to_milliseconds(stats.budget)) : Json(nullptr);
  stage["overruns"] = if_measured(stats.wall.count() > 0, stats.overruns.get());
  add_percentiles(stage, "cpu_", stats.cpu);
  return stage;
}

Json stages_json(const Monitor* monitor) {
  Json stages = Json::object();
  if (monitor != nullptr)
    for (const StageStats& s : monitor->stages()) stages[s.name] = stage_json(s);
  return stages;
}

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

Json task_json(const TaskFigures& task) {
  const scheduler::TaskStats& s = task.stats;
  Json json{{"count", s.ticks.get()},
            {"rate_hz", task.spec.rate_hz},
            {"deadline_ms", to_milliseconds(task.spec.deadline())},
            {"budget_ms", task.spec.soft_ms},
            {"slips", if_measured(s.measured(), s.slips.get())},
            {"missed", if_measured(s.measured(), s.misses.get())},
            {"miss_ratio", if_measured(s.measured(), ratio(s.misses, s.ticks))},
            {"slip_ratio", if_measured(s.measured(), ratio(s.slips, s.ticks + s.slips))},
            {"soft_overruns", if_measured(s.measured(), s.soft_overruns.get())},
            {"hard_overruns", if_measured(s.measured(), s.hard_overruns.get())},
            {"demotions", if_measured(s.measured(), s.demotions.get())},
            {"allocations", if_measured(s.usage_measured(), s.allocations.get())},
            {"major_faults", if_measured(s.usage_measured(), s.major_faults.get())},
            {"minor_faults", if_measured(s.usage_measured(), s.minor_faults.get())},
            {"involuntary_switches", if_measured(s.usage_measured(), s.involuntary_switches.get())}};
  add_percentiles(json, "response_", s.response);
  add_percentiles(json, "wake_", s.wake);
  add_percentiles(json, "execution_", s.execution);
  add_percentiles(json, "cpu_", s.cpu);
  return json;
}

Json ticks_json(const TickStats& ticks) {
  const auto late_us = [](Duration late) { return 1e-3 * static_cast<double>(late.count()); };
  return {{"count", ticks.count},
          {"missed", or_null(ticks.missed)},
          {"max_lateness_us", ticks.max_lateness ? Json(late_us(*ticks.max_lateness)) : Json(nullptr)}};
}

Json shed_json(const RunReport& report) {
  Json shed = Json::object();
  for (const auto& [level, scans] : report.shed) shed[level] = scans;
  return shed;
}

Json losses_json(const RunReport& report) {
  Json losses = Json::object();
  for (const auto& [device, counts] : report.losses) {
    losses[device] = Json::object();
    for (const auto& [name, count] : counts) losses[device][name] = count;
  }
  return losses;
}

Json tasks_json(const RunReport& report) {
  Json tasks = Json::object();
  for (const TaskFigures& task : report.tasks) tasks[task.spec.name] = task_json(task);
  return tasks;
}

Json events_json(const RunReport& report) {
  Json events = Json::array();
  if (report.monitor == nullptr) return events;
  for (const Event& e : report.monitor->events())
    events.push_back({{"first_s", to_seconds(e.first - report.start)},
                      {"last_s", to_seconds(e.last - report.start)},
                      {"stage", e.stage},
                      {"what", e.what},
                      {"count", e.count}});
  return events;
}

Json peers_json(const RunReport& report) {
  Json peers = Json::object();
  for (const auto& [name, p] : report.peers)
    peers[name] = {{"tx_bytes", p.tx_bytes},
                   {"people_tx_bytes", p.people_tx_bytes},
                   {"rx_bytes", p.rx_bytes},
                   {"tiles", p.tiles},
                   {"age_p99_s", or_null(p.age_p99_s)},
                   {"T_map_peer", p.T_map_peer ? numbers(p.T_map_peer->mean.matrix()) : Json(nullptr)},
                   {"covariance", p.T_map_peer ? numbers(p.T_map_peer->covariance) : Json(nullptr)},
                   {"accepted", p.accepted},
                   {"state", p.state},
                   {"reason", p.reason},
                   {"deployment_contradicted", p.deployment_contradicted}};
  return peers;
}

Json team_json(const RunReport& report) {
  if (!report.team) return nullptr;
  const TeamStats& t = *report.team;
  Json poses = Json::object();
  for (const auto& [robot, pose] : t.T_team_odom) poses[std::to_string(robot)] = numbers(pose.matrix());
  return {{"id", t.id},
          {"anchor", t.anchor},
          {"T_team_odom", poses},
          {"merged_with", t.merged_with},
          {"tiles", t.tiles},
          {"held_back", {{"times", t.held_back_times}, {"s", t.held_back_s}, {"tiles", t.held_back_tiles}}},
          {"satellites",
           {{"fixes", t.satellite_fixes},
            {"T_site_odom", t.T_site_odom ? numbers(t.T_site_odom->mean.matrix()) : Json(nullptr)},
            {"covariance", t.T_site_odom ? numbers(t.T_site_odom->covariance) : Json(nullptr)}}},
          {"positions", t.positions ? to_json(*t.positions) : Json(nullptr)},
          {"sha256", t.sha256}};
}

Json ground_truth_json(const RunReport& report) {
  const Accuracy accuracy = accuracy_of(report);
  if (!accuracy.why_not.empty()) return {{"error", accuracy.why_not}};
  if (!accuracy.error) return nullptr;
  Json json = to_json(*accuracy.error);
  const auto inside = share_inside_3_sigma(accuracy.pose_errors);
  for (std::size_t i = 0; const char* axis : {"x", "y", "z", "roll", "pitch", "yaw"})
    json["inside_3_sigma"][axis] = or_null(inside[i++]);
  return json;
}

Json notes_json(const RunReport& report) {
  Json notes = Json::array();
  for (const Note& note : notes_of(report))
    notes.push_back({{"severity", to_string(note.severity)}, {"text", note.text}, {"remedy", note.remedy}});
  return notes;
}

Json map_json(const RunReport& report) {
  const MapSummary& map = report.map;
  Json joined = Json::array();
  for (const auto& [file, pose] : report.joined_maps)
    joined.push_back({{"file", file}, {"T_map_earlier", numbers(pose.matrix())}});
  return {{"resolution_m", map.resolution_m},
          {"occupied", map.occupied},
          {"free", map.free},
          {"labelled", map.labelled},
          {"cleared", report.cleared_voxels},
          {"bytes", map.memory_bytes},
          {"file_bytes", or_null(report.map_file_bytes)},
          {"nodes", map.nodes},
          {"mean_entropy_occupancy", or_null(map.mean_entropy_occupancy)},
          {"earlier", report.earlier_maps},
          {"earlier_not_kept", report.dropped_maps},
          {"joined", joined}};
}

Json odometry_json(const OdometryStats& odometry) {
  return {{"degenerate_scans", odometry.degenerate_scans},
          {"wheel_scans", odometry.wheel_scans},
          {"wheels_wrong_scans", odometry.wheels_wrong_scans},
          {"lost_scans", odometry.lost_scans},
          {"lost_s", odometry.lost_s},
          {"mean_iterations", or_null(odometry.mean_iterations)}};
}

}  // namespace

Json to_json(const TrajectoryError& e) {
  const auto of = [](const std::optional<RelativeError>& r, double RelativeError::*member) {
    return r ? Json((*r).*member) : Json(nullptr);
  };
  return {{"ate_rmse_m", e.ate_rmse_m},
          {"rpe_trans_percent", of(e.segments, &RelativeError::trans_percent)},
          {"rpe_rot_deg_per_m", of(e.segments, &RelativeError::rot_deg_per_m)},
          {"final_error_percent", or_null(e.final_error_percent)},
          {"length_m", e.length_m},
          {"duration_s", e.duration_s},
          {"final_error_m", e.final_error_m},
          {"ate_percent", e.final_error_percent ? Json(100 * e.ate_rmse_m / e.length_m) : Json(nullptr)},
          {"ate_max_m", e.ate_max_m},
          {"ate_first_rmse_m", e.ate_first_rmse_m},
          {"ate_se3_rmse_m", e.ate_se3_rmse_m},
          {"step_trans_percent", of(e.steps, &RelativeError::trans_percent)},
          {"step_rot_deg_per_m", of(e.steps, &RelativeError::rot_deg_per_m)},
          {"segments", e.segments ? Json(e.segments->segments) : Json(0)},
          {"matched", e.matched},
          {"unmatched", e.unmatched}};
}

Json to_json(const RunReport& report) {
  return {{"robot", report.robot},
          {"profile", report.profile},
          {"source", report.source},
          {"version", report.version},
          {"interrupted", report.interrupted},
          {"incomplete", report.incomplete},
          {"started", report.started.empty() ? Json(nullptr) : Json(report.started)},
          {"notes", notes_json(report)},
          {"distance_m", or_null(report.distance_m)},
          {"duration_s", or_null(report.duration_s)},
          {"scans", report.scans},
          {"lost_packets", or_null(report.lost_packets)},
          {"losses", losses_json(report)},
          {"stages", stages_json(report.monitor)},
          {"ticks", ticks_json(report.ticks)},
          {"tasks", tasks_json(report)},
          {"mode", report.mode},
          {"mode_cause", report.mode_cause},
          {"shed", shed_json(report)},
          {"odometry", odometry_json(report.odometry)},
          {"ground_truth", ground_truth_json(report)},
          {"map", map_json(report)},
          {"labels", labels_json(report)},
          {"people", people_json(report)},
          {"mounts", mounts_json(report)},
          {"depth", depth_json(report)},
          {"visual_odometry", visual_odometry_json(report)},
          {"memory", {{"peak_rss_mb", report.peak_rss_mb}}},
          {"allocations", {{"control_thread", or_null(report.control_thread_allocations)}}},
          {"peers", peers_json(report)},
          {"team", team_json(report)},
          {"events", events_json(report)},
          {"dropped_events", report.monitor != nullptr ? report.monitor->dropped_events() : 0},
          {"output_sha256", report.output_sha256}};
}

std::string to_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace cairn::report
