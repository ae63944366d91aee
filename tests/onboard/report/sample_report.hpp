// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "onboard/report/figures/run_report.hpp"

namespace cairn::report {

inline Time at_seconds(double s) { return Time{from_seconds(s)}; }

/// A run that never was: a robot drives round two rooms. Owns what the report refers to.
struct SampleRun {
  Monitor monitor;
  std::unique_ptr<mapping::SemanticOcTree> map;
  RunReport report;
};

namespace sample {

inline void box(mapping::SemanticOcTree& map, const Eigen::Vector3d& low, const Eigen::Vector3d& high, bool occupied) {
  const double r = map.getResolution();
  for (double x = low.x(); x < high.x(); x += r)
    for (double y = low.y(); y < high.y(); y += r)
      for (double z = low.z(); z < high.z(); z += r)
        map.updateNode(octomap::point3d(static_cast<float>(x + r / 2), static_cast<float>(y + r / 2),
                                        static_cast<float>(z + r / 2)),
                       occupied ? 2.0F : -2.0F, true);
}

/// Two rooms of 8 × 6 × 2.8 m with a door between them, floor, ceiling and a few boxes.
inline std::unique_ptr<mapping::SemanticOcTree> rooms(double resolution) {
  auto map = std::make_unique<mapping::SemanticOcTree>(resolution);
  const double r = resolution;
  box(*map, {-2, -2, -0.2}, {14, 4, 2.6}, false);
  box(*map, {-2, -2, -0.2 - r}, {14, 4, -0.2}, true);
  box(*map, {-2, -2, 2.6}, {14, 4, 2.6 + r}, true);
  box(*map, {-2, -2 - r, -0.2}, {14, -2, 2.6}, true);
  box(*map, {-2, 4, -0.2}, {14, 4 + r, 2.6}, true);
  box(*map, {-2 - r, -2, -0.2}, {-2, 4, 2.6}, true);
  box(*map, {14, -2, -0.2}, {14 + r, 4, 2.6}, true);
  box(*map, {6, -2, -0.2}, {6 + r, 0.4, 2.6}, true);
  box(*map, {6, 1.6, -0.2}, {6 + r, 4, 2.6}, true);
  box(*map, {2, 2.6, -0.2}, {3.6, 3.4, 0.6}, true);
  box(*map, {10, -1.4, -0.2}, {10.8, -0.6, 1.4}, true);
  map->updateInnerOccupancy();
  map->prune();
  return map;
}

inline SE3 pose_at(double s) {
  const double a = 2 * std::numbers::pi * s / 60;
  return SE3::from_xyz_rpy((Vector6() << 6 - 6 * std::cos(a), 1.4 * std::sin(2 * a), 0, 0, 0,
                            std::atan2(2.8 * std::cos(2 * a), 6 * std::sin(a) + 1e-9))
                               .finished());
}

inline void drive(RunReport& report, int poses, double drift) {
  std::mt19937 engine(5);
  std::normal_distribution<double> noise(0, 1);
  const SE3 T_world_odom = SE3::from_xyz_rpy((Vector6() << 3, 20, 0, 0, 0, 0.4).finished());
  Vector6 error = Vector6::Zero();
  for (int i = 0; i < poses; ++i) {
    const double s = 0.1 * i;
    for (Eigen::Index k = 0; k < 6; ++k) error(k) += (i == 0 ? 0 : drift) * (k < 3 ? 1.0 : 0.3) * noise(engine);
    Matrix6 covariance = Matrix6::Zero();
    for (Eigen::Index k = 0; k < 6; ++k) covariance(k, k) = i * std::pow(drift * (k < 3 ? 1.0 : 0.3), 2);
    report.trajectory.push_back({at_seconds(100 + s), {pose_at(s) * SE3::exp(error), covariance}});
    const auto& before = report.trajectory[i == 0 ? 0 : report.trajectory.size() - 2].T_odom_base.mean;
    report.distance_m = report.distance_m.value_or(0) +
                        (report.trajectory.back().T_odom_base.mean.translation() - before.translation()).norm();
  }
  for (int i = -5; i < poses * 5 + 5; ++i)
    report.ground_truth.push_back({at_seconds(100 + 0.02 * i), T_world_odom * pose_at(0.02 * i)});
}

inline void spend(Monitor& monitor, int scans) {
  std::mt19937 engine(11);
  std::lognormal_distribution<double> spread(0, 0.25);
  const auto stage = [&](const char* name, double budget_ms, double typical_ms) {
    StageStats& s = monitor.stage(name, from_seconds(1e-3 * budget_ms));
    for (int i = 0; i < scans; ++i) {
      const double ms = typical_ms * spread(engine) * (i % 97 == 13 ? 3.5 : 1.0);
      s.cpu.record(from_seconds(1e-3 * ms));
      s.wall.record(from_seconds(1e-3 * ms * (1 + 0.4 * spread(engine))));
      if (budget_ms > 0 && ms * 1.4 > budget_ms) ++s.overruns;
    }
  };
  stage("decode", 5, 0.35);
  stage("deskew", 0, 0.6);
  stage("odometry", 30, 7.2);
  stage("map", 60, 16);
}

/// A live run's tasks, one of which came too late twice.
inline void schedule(RunReport& report, const std::string& name) {
  std::mt19937 engine(3);
  std::lognormal_distribution<double> spread(0, 0.4);
  const auto task = [&](const std::string& what, double rate_hz, double deadline_ms, double typical_ms) {
    TaskFigures& t = report.tasks.emplace_back();
    t.spec.name = what, t.spec.rate_hz = rate_hz, t.spec.deadline_ms = deadline_ms;
    for (int i = 0; i < 20'000; ++i) {
      const double ms = typical_ms * spread(engine);
      t.stats.response.record(from_seconds(1e-3 * (ms + 0.06)));
      t.stats.wake.record(from_seconds(0.06e-3 * spread(engine)));
      ++t.stats.ticks;
      ++t.stats.warm_ticks;
    }
    t.stats.involuntary_switches = 12;
    t.stats.minor_faults = 7;
  };
  task("safety" + name, 500, 2, 0.008);
  task("drive", 500, 2, 0.02);
  task("odometry", 100, 100, 22);
  report.tasks.back().stats.misses = 2;
  report.tasks.back().stats.soft_overruns = 41;
  report.mode = "hold", report.mode_cause = "lidar_silent" + name;
  report.shed = {{"nothing", 560}, {"peer tiles" + name, 40}, {"scans", 0}};
}

}  // namespace sample

/// A run of which there is nothing to say.
inline RunReport uneventful() {
  RunReport report;
  report.scans = 1;
  report.trajectory.resize(1);
  report.map.occupied = 1;
  return report;
}

/// `hostile` puts markup and broken bytes into every text.
inline std::unique_ptr<SampleRun> sample_run(int scans = 600, double resolution = 0.2, bool hostile = false) {
  auto run = std::make_unique<SampleRun>();
  RunReport& r = run->report;
  const auto text = [&](const char* plain) {
    return std::string(plain) + (hostile ? "<script>alert(\"1\")</script>&'\x01\xff" : "");
  };
  run->map = sample::rooms(resolution);
  r.robot = text("robot_1"), r.profile = text("husky"), r.source = text("recordings/office/robot_1");
  r.version = text("0.1.0"), r.started = text("2024-05-06 07:08:09 UTC");
  r.start = at_seconds(100);
  r.duration_s = 0.1 * scans, r.scans = static_cast<std::uint64_t>(scans), r.lost_packets = 3;
  r.ticks = {static_cast<std::uint64_t>(scans) * 10, 0, from_seconds(180e-6)};
  r.odometry.degenerate_scans = 14;
  r.odometry.mean_iterations = 6.4;
  r.peak_rss_mb = 143.2;
  r.control_thread_allocations = 0;
  sample::drive(r, scans, 6e-4);
  sample::spend(run->monitor, scans);
  r.monitor = &run->monitor;
  run->monitor.event(at_seconds(112.4), text("velodyne"), text("3 packets lost"));
  run->monitor.event(at_seconds(131.0), text("odometry"),
                     text("degenerate along x: the corridor's axis is not observable"));
  run->monitor.event(at_seconds(133.5), text("odometry"),
                     text("degenerate along x: the corridor's axis is not observable"));
  sample::schedule(r, text(""));
  r.map = summarise(*run->map);
  r.map_file_bytes = 48213;
  if (auto picture = look_at(*run->map, {})) r.picture = std::move(*picture);
  r.peers[text("robot_2")] = {120000, 98000,    341, 0.42, UncertainPose{sample::pose_at(3), Matrix6::Identity()},
                              true,   "merged", ""};
  r.peers[text("robot_3")] = {1000, 0, 0, {}, {}, false, text("no_place"), text("too little overlap")};
  r.effective_config = text("voxel_size_m: 0.5  # m, edge of a map voxel\nmax_range_m: 30\n");
  r.output_sha256 = "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08";
  return run;
}

}  // namespace cairn::report
