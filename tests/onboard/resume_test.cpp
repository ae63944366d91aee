// SPDX-License-Identifier: Apache-2.0
// A robot that dies on its way and goes on from what it saved.
#include <gtest/gtest.h>

#include <cstdio>

#include "onboard/app/restart/generations.hpp"
#include "onboard/robot.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"
#include "tests/support/box_world.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn {
namespace {

const SE3 kMount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished());

/// A ride through a scene, one scan every 0.1 s, whoever is there to see it.
class Journey {
 public:
  explicit Journey(const support::Scene& scene, double brake_at_s)
      : world_(scene.world), path_(scene.ride, 30), brake_at_s_(brake_at_s) {
    config.T_base_lidar = kMount;
    config.mapping.reserve_mb = 1;
    config.mapping.max_range_m = 60;  // in a car park, what tells how far one went may be 40 m away
  }

  Scan next() {
    return lidar_.scan(
        world_, [this](double t) { return at(t); }, 0.1 * scans_++);
  }
  void miss(int scans) { scans_ += scans; }
  void step(Robot& robot) { step(robot, next()); }
  void step(Robot& robot, const Scan& scan) {
    Budget budget = Budget::steps(12);
    const auto point = robot.locate(scan, budget, located);
    EXPECT_TRUE(robot.extend_map(located));
    ASSERT_TRUE(point) << to_string(point.error());
    if (const SE3& T = point->T_odom_base.mean; selection_.wants(T)) {
      selection_.take(T);
      odometry::PlacedScan scan_placed{.stamp = located.stamp, .T_odom_base = T, .points_base = {}};
      thin_(located.points_base, scan_placed.points_base);
      recent.add(std::move(scan_placed));
    }
    if (scans_ == 1) T_world_odom_ = at(to_seconds(scan.valid.end));
    last = *point;
  }
  [[nodiscard]] app::SavedScans saved_scans() const { return {0, {recent.scans().begin(), recent.scans().end()}}; }
  /// T_estimate⁻¹·T_truth of the last step.
  [[nodiscard]] Vector6 error() const {
    const SE3 truth = T_world_odom_.inverse() * at(to_seconds(last.stamp));
    return (last.T_odom_base.mean.inverse() * truth).log();
  }

  RobotConfig config;
  Workers workers{2};
  Monitor monitor;
  TrackPoint last;
  LocatedScan located;
  odometry::RecentScans recent;

 private:
  /// Without its core the robot comes to rest, as its motors' watchdog sees to, and later goes on from there.
  [[nodiscard]] SE3 at(double t) const {
    constexpr double kBrake = 0.5, kRest = 1.5;
    const double since = t - brake_at_s_;
    if (since <= 0) return path_(t);
    const double braked = std::min(since, kBrake), rest = brake_at_s_ + braked - braked * braked / (2 * kBrake);
    const double again = std::max(0.0, since - kRest), start = std::min(again, 1.0);
    return path_(rest + again - start + start * start / 2);
  }

  support::World world_;
  support::RidePath path_;
  double brake_at_s_;
  support::Vlp16 lidar_{kMount, 0.02, 1};
  odometry::ScanSelection selection_;
  odometry::ScanThinning thin_{odometry::OdometryConfig{}};
  SE3 T_world_odom_;
  int scans_ = 0;
};

app::SavedState state_of(const Journey& journey) {
  app::SavedState state;
  state.boot = "b";
  state.stamp = journey.last.stamp;
  state.T_odom_base = journey.last.T_odom_base;
  state.twist = journey.last.twist;
  return state;
}

Resume resume(const app::Generation& saved) {
  return {.map = *saved.map,
          .map_stamp = saved.map_stamp,
          .scans = saved.scans,
          .T_odom_base = saved.state.T_odom_base,
          .twist = saved.state.twist,
          .stamp = saved.state.stamp};
}

std::string death_name(const testing::TestParamInfo<std::tuple<support::Scene, int>>& test) {
  return std::get<0>(test.param).name + "_after_" + std::to_string(std::get<1>(test.param)) + "_scans";
}

class Resumed : public testing::TestWithParam<std::tuple<support::Scene, int>> {};

TEST_P(Resumed, TheTrajectoryGoesOn) {
  const auto& [scene, scans] = GetParam();
  support::TemporaryFolder folder;
  Journey journey(scene, 0.1 * scans + 0.2);
  app::Generations generations(folder.path(), journey.monitor);
  Vector6 before;
  {
    Robot robot(journey.config, journey.workers, journey.workers, journey.monitor);
    for (int i = 0; i < scans / 2; ++i) journey.step(robot);
    ASSERT_TRUE(generations.save(robot.map(), state_of(journey)));
    for (int i = scans / 2; i < scans; ++i) journey.step(robot);
    ASSERT_TRUE(generations.save_state(state_of(journey)));
    ASSERT_TRUE(generations.save_scans(journey.saved_scans()));
    before = journey.error();
  }
  journey.miss(12);  // dead: 0.2 s at full speed, then braking, then at rest

  const auto saved = app::Generations(folder.path(), journey.monitor).load(Time{});
  ASSERT_TRUE(saved);
  Robot robot(journey.config, journey.workers, journey.workers, journey.monitor, resume(*saved));
  journey.step(robot);
  const Vector6 first = journey.error();
  EXPECT_EQ(journey.located.epoch, 0U);
  for (int i = 0; i < 6; ++i) journey.step(robot);
  const Vector6 later = journey.error();
  EXPECT_FALSE(journey.last.lost);
  std::printf("%-10s %2d scans: %.3f m %.2f deg, again %.3f m %.2f deg, later %.3f m %.2f deg\n", scene.name.c_str(),
              scans, before.head<3>().norm(), before.tail<3>().norm() * 57.3, first.head<3>().norm(),
              first.tail<3>().norm() * 57.3, later.head<3>().norm(), later.tail<3>().norm() * 57.3);
  EXPECT_LT(first.head<3>().norm(), before.head<3>().norm() + 0.05);
  EXPECT_LT(first.tail<3>().norm(), before.tail<3>().norm() + 0.01);
  EXPECT_LT(later.head<3>().norm(), before.head<3>().norm() + 0.05);
  EXPECT_LT(later.tail<3>().norm(), before.tail<3>().norm() + 0.01);
}

// A longer way before the end tells the same and takes minutes under a sanitiser.
INSTANTIATE_TEST_SUITE_P(Scenes, Resumed,
                         testing::Combine(testing::Values(support::corridor(), support::lobby(), support::office(),
                                                          support::carpark()),
                                          testing::Values(10)),
                         death_name);

class CarriedAway : public testing::TestWithParam<std::tuple<support::Scene, int>> {};

TEST_P(CarriedAway, TheMapBeginsAnew) {
  const auto& [scene, scans] = GetParam();
  Journey journey(scene, 100);
  std::unique_ptr<Robot> robot =
      std::make_unique<Robot>(journey.config, journey.workers, journey.workers, journey.monitor);
  for (int i = 0; i < scans; ++i) journey.step(*robot);
  const app::Generation saved{state_of(journey),           std::make_unique<mapping::SemanticOcTree>(robot->map()),
                              journey.last.stamp,          0,
                              journey.saved_scans().scans, {}};
  journey.miss(60);
  Robot again(journey.config, journey.workers, journey.workers, journey.monitor, resume(saved));
  const Scan first = journey.next();
  journey.step(again, first);
  EXPECT_EQ(journey.located.epoch, 1U);
  EXPECT_EQ(journey.last.T_odom_base.mean.log().norm(), 0);
  Robot stranger(journey.config, journey.workers, journey.workers, journey.monitor);
  journey.step(stranger, first);
  EXPECT_EQ(mapping::differing_nodes(again.map(), stranger.map()), 0U);
}

INSTANTIATE_TEST_SUITE_P(Scenes, CarriedAway,
                         testing::Combine(testing::Values(support::corridor(), support::office()), testing::Values(10)),
                         death_name);

}  // namespace
}  // namespace cairn
