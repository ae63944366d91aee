// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/run_output.hpp"

#include <algorithm>
#include <fstream>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/formats/utc.hpp"
#include "hal/files/file.hpp"
#include "hal/files/sha256.hpp"
#include "onboard/app/door/door.hpp"
#include "onboard/app/door/fitted.hpp"
#include "onboard/app/mount_figures.hpp"
#include "onboard/app/people_figures.hpp"
#include "onboard/app/rejoin/joined_track.hpp"
#include "onboard/app/results_folder.hpp"
#include "onboard/app/run.hpp"
#include "onboard/app/runs/connect_inputs.hpp"
#include "onboard/app/tasks/robot_tasks.hpp"
#include "onboard/app/team/team_output.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/write_report.hpp"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

/// See Recording::time_shift_ns.
Duration shift_of(const RunFacts& facts) { return Duration{facts.door.recording.time_shift_ns}; }

/// On the time line of the recording, where one was played.
Result<void> write_trajectory(const fs::path& file, const std::vector<TrackPoint>& track, Duration shift) {
  std::vector<recording::StampedPose> poses;
  poses.reserve(track.size());
  for (const TrackPoint& p : track) poses.push_back({p.stamp - shift, p.T_odom_base.mean});
  return recording::write_tum(file, poses);
}

report::OdometryStats odometry_stats(const std::vector<TrackPoint>& track) {
  report::OdometryStats stats;
  double iterations = 0;
  Time before = track.empty() ? Time{} : track.front().stamp;
  for (const TrackPoint& p : track) {
    stats.degenerate_scans += p.degenerate_directions > 0 ? 1U : 0U;
    stats.wheel_scans += p.by_wheels ? 1U : 0U;
    stats.lost_scans += p.lost ? 1U : 0U;
    if (p.wrong_wheel_scale != 0) ++stats.wheels_wrong_scans, stats.wrong_wheel_scale = p.wrong_wheel_scale;
    stats.lost_s += p.lost ? to_seconds(p.stamp - before) : 0;
    iterations += p.iterations;
    before = p.stamp;
  }
  if (!track.empty()) stats.mean_iterations = iterations / static_cast<double>(track.size());
  return stats;
}

std::optional<double> length_m(const std::vector<TrackPoint>& track) {
  if (track.empty()) return std::nullopt;
  double length = 0;
  for (std::size_t i = 1; i < track.size(); ++i)
    length += (track[i].T_odom_base.mean.translation() - track[i - 1].T_odom_base.mean.translation()).norm();
  return length;
}

/// The control thread is that of the safety task.
void add_tasks(const RobotTasks& tasks, report::RunReport& report) {
  for (const scheduler::ScheduledTask& task : tasks.graph.tasks()) report.tasks.push_back({task.spec, task.stats});
  const scheduler::TaskStats& control = tasks.graph.scheduled(tasks.safety).stats;
  report.ticks.count = control.ticks;
  if (control.measured()) {
    report.ticks.missed = control.misses + control.slips;
    report.ticks.max_lateness = control.wake.max();
  }
  if (control.usage_measured())
    report.control_thread_allocations = control.allocations + tasks.graph.scheduled(tasks.drive).stats.allocations;
}

/// A level that leaves nothing out is reported as the one before it.
void add_shed(const MappingTask& mapping, report::RunReport& report) {
  for (int i = 0; i < safety::kShedLevels; ++i) {
    const auto level = static_cast<safety::Shed>(i);
    const std::uint64_t scans = mapping.scans_at()[static_cast<std::size_t>(i)];
    if (safety::in_force(level, mapping.shed_work()) == level)
      report.shed.emplace_back(to_string(level), scans);
    else
      report.shed.back().second += scans;
  }
}

void add_labels(const RobotTasks& tasks, const Monitor& monitor, report::RunReport& report) {
  if (!tasks.perception) return;
  const PerceptionTask::Figures& looked = tasks.perception->figures();
  const LabelJoiner::Figures& joined = tasks.mapping.label_figures();
  report.labels = report::LabelStats{.images = joined.images,
                                     .points = joined.points,
                                     .voxels = joined.voxels,
                                     .latency_p99_ms = std::nullopt,
                                     .passed = looked.passed,
                                     .shed = looked.shed,
                                     .refused = looked.refused + looked.unlabelled,
                                     .apart = joined.apart};
  for (const StageStats& stage : monitor.stages())
    if (stage.name == kPictureToMap && stage.wall.count() > 0)
      report.labels->latency_p99_ms = to_milliseconds(stage.wall.percentile(0.99));
}

void add_depth(const RobotTasks& tasks, report::RunReport& report) {
  if (!tasks.depth) return;
  const DepthTask::Figures& looked = tasks.depth->figures();
  const CloudJoiner::Figures& joined = tasks.mapping.cloud_figures();
  report.depth = report::DepthStats{.images = joined.clouds,
                                    .points = joined.points,
                                    .passed = looked.passed,
                                    .refused = looked.refused,
                                    .apart = joined.apart};
}

void add_visual(const RobotTasks& tasks, report::RunReport& report) {
  if (!tasks.visual) return;
  const VisualOdometryTask::Figures& looked = tasks.visual->figures();
  const StereoTask::Figures& measured = tasks.stereo->figures();
  report.visual_odometry = report::VisualStats{.frames = looked.frames,
                                               .tracked = looked.tracked,
                                               .lost = looked.frames - looked.tracked,
                                               .refused = looked.refused,
                                               .clouds = measured.clouds,
                                               .points = measured.points};
}

/// Empty where the recording knows no time of day.
std::string utc_of(Time t, const recording::Recording& recording) {
  const std::int64_t utc_ns = recording.utc_ns(t);
  const bool known = recording.realtime_offset_ns != 0 || recording.start_utc_ns != 0;
  return known && utc_ns > 0 ? recording::to_iso_utc(utc_ns) : std::string();
}

void add_input(const RunFacts& facts, report::RunReport& report) {
  const ReceiveTask::Figures& figures = facts.tasks.receive.figures();
  report.scans = facts.tasks.looks();
  const auto& sources = facts.door.recording.sources;
  if (figures.scans > 0 && has_kind(sources, recording::kVelodyne)) report.lost_packets = figures.lost_packets;
  for (const Input& input : facts.door.inputs)
    if (input.losses) report.losses.emplace_back(input.entry.id, input.losses());
  report.missing_packets = missing_packets(facts.tasks);
  const drive::CanDrive* drive = facts.tasks.drive.drive();
  report.wheels_unread = drive != nullptr && !drive->reads_wheels();
  if (!figures.start) return;
  report.start = *figures.start;
  report.started = utc_of(*figures.start, facts.door.recording);
  report.duration_s = to_seconds(figures.end - *figures.start);
}

/// Every stage of the odometry and the map, as far as the run got.
report::RunReport make_report(const RunFacts& facts, const std::vector<TrackPoint>& track) {
  report::RunReport report;
  report.robot = facts.profile.name;
  report.profile = facts.profile_file.string();
  report.live = facts.options.recording.empty();
  report.source = report.live ? "live" : facts.options.recording.string();
  report.version = CAIRN_VERSION;
  report.interrupted = facts.end == RunEnd::kInterrupted;
  if (facts.lost_schedule) report.lost_schedule = to_string(*facts.lost_schedule);
  report.distance_m = length_m(track);
  add_input(facts, report);
  report.odometry = odometry_stats(track);
  report.peak_rss_mb = report::peak_rss_mb();
  add_tasks(facts.tasks, report);
  report.mode = to_string(facts.tasks.safety.decision().mode);
  if (const auto cause = facts.tasks.safety.decision().cause) report.mode_cause = to_string(*cause);
  add_shed(facts.tasks.mapping, report);
  add_labels(facts.tasks, facts.monitor, report);
  add_depth(facts.tasks, report);
  add_visual(facts.tasks, report);
  add_people(facts.tasks, report);
  add_mounts(facts.tasks, report);
  report.monitor = &facts.monitor;
  for (const TrackPoint& p : track) report.trajectory.push_back({p.stamp, p.T_odom_base});
  report.map = report::summarise(facts.tasks.robot.map());
  if (auto picture = report::look_at(facts.tasks.robot.map(), {})) report.picture = std::move(*picture);
  report.effective_config = to_yaml(facts.profile);
  if (facts.tasks.team) add_team(facts.tasks.team->team(), report);
  return report;
}

/// The truth beside a simulated recording; a run without one is as good as any.
void add_ground_truth(const RunFacts& facts, report::RunReport& report) {
  const fs::path file = facts.options.recording / "ground_truth.tum";
  if (facts.options.recording.empty() || !fs::exists(file)) return;
  if (auto truth = recording::read_tum(file))
    for (const auto& p : *truth) report.ground_truth.push_back({p.stamp + shift_of(facts), p.pose});
}

/// One file for each epoch that ended during the run: their maps do not lie in the frame of map.cairn.
Result<void> write_earlier_maps(const RunFacts& facts, const fs::path& folder, report::RunReport& report,
                                std::vector<fs::path>& hashed) {
  const Robot& robot = facts.tasks.robot;
  for (const EarlierMap& map : robot.earlier_maps().all()) {
    const std::string name = earlier_map_file(map.epoch);
    if (const auto place = robot.earlier_maps().between(robot.map_epoch(), map.epoch))
      report.joined_maps.emplace_back(name, place->mean);
    else
      report.earlier_maps.push_back(name);
    hashed.push_back(folder / name);
    if (const auto r = mapping::save_cairn(*map.tree, hashed.back()); !r) return r.error();
  }
  report.cleared_voxels = robot.cleared_voxels();
  report.dropped_maps = robot.earlier_maps().dropped();
  return {};
}

/// What a team run leaves besides, as a part of what is to be repeated.
Result<void> add_team_files(const RunFacts& facts, const fs::path& folder, report::RunReport& report,
                            std::vector<fs::path>& hashed) {
  if (!facts.tasks.team || !facts.tasks.team->team().team()) return {};
  const auto files = write_team(*facts.tasks.team->team().team(), folder);
  if (!files) return files.error();
  const auto hash = sha256_of_files(files->same);
  if (!hash) return hash.error();
  report.team->sha256 = *hash;
  report.team->positions = files->positions;
  hashed.insert(hashed.end(), files->same.begin(), files->same.end());
  return {};
}

/// All files of a run.
Result<report::RunReport> write_results(const RunFacts& facts, const fs::path& folder) {
  const std::vector<TrackPoint> track = joined_track(facts.tasks.robot);
  report::RunReport report = make_report(facts, track);
  add_ground_truth(facts, report);
  std::vector<fs::path> hashed{folder / "trajectory.tum", folder / kResultMap};
  if (const auto r = write_trajectory(hashed[0], track, shift_of(facts)); !r) return r.error();
  if (const auto r = write_file_atomic(folder / "config.yaml", report.effective_config); !r) return r.error();
  // A full disk takes small files first, and their report says by itself that the rest is missing.
  report.incomplete = true;
  if (const auto r = report::write_report(report, folder); !r) return r.error();
  if (const auto r = mapping::save_cairn(facts.tasks.robot.map(), hashed[1]); !r) return r.error();
  if (const auto r = mapping::save_ot(facts.tasks.robot.map(), folder / "map.ot"); !r) return r.error();
  const auto people = write_people(facts.tasks, facts.profile.perception.people, shift_of(facts), folder);
  if (!people) return people.error();
  hashed.insert(hashed.end(), people->begin(), people->end());
  if (const auto r = write_earlier_maps(facts, folder, report, hashed); !r) return r.error();
  if (const auto r = add_team_files(facts, folder, report, hashed); !r) return r.error();
  const auto hash = sha256_of_files(hashed);
  if (!hash) return hash.error();
  report.output_sha256 = *hash;
  std::error_code ignored;
  report.map_file_bytes = fs::file_size(hashed[1], ignored);
  report.incomplete = false;
  if (const auto r = report::write_report(report, folder); !r) return r.error();
  return report;
}

}  // namespace

Result<UnfinishedFolder> prepare_output(const fs::path& out) { return UnfinishedFolder::inside(out); }

Result<RunOutput> write_output(const RunFacts& facts, UnfinishedFolder& unfinished) {
  auto report = write_results(facts, unfinished.path());
  if (!report) return keep_incomplete(unfinished, report.error());
  auto folder = put_in_place(facts.options.out, unfinished, report->scans);
  if (!folder) return keep_incomplete(unfinished, folder.error());
  return RunOutput{std::move(*report), std::move(*folder)};
}

}  // namespace cairn::app
