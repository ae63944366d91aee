// SPDX-License-Identifier: Apache-2.0
// A robot that dies on its way and goes on from what it saved. It must have seen enough: after half of the way (2.4 s
// of mapping) the way back is not found in office and car park, and the odometry does not notice.
#include <gtest/gtest.h>

#include <cstdio>

#include "onboard/app/generations.hpp"
#include "onboard/robot.hpp"
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
  void step(Robot& robot) {
    const Scan scan = next();
    Budget budget = Budget::steps(12);
    LocatedScan located;
    const auto point = robot.locate(scan, budget, located);
    EXPECT_TRUE(robot.extend_map(located));
    ASSERT_TRUE(point) << to_string(point.error());
    if (scans_ == 1) T_world_odom_ = at(to_seconds(scan.valid.end));
    last = *point;
  }
  /// T_estimate⁻¹·T_truth of the last step.
  [[nodiscard]] Vector6 error() const {
    const SE3 truth = T_world_odom_.inverse() * at(to_seconds(last.stamp));
    return (last.T_odom_base.mean.inverse() * truth).log();
  }

  RobotConfig config;
  Workers workers{2};
  Monitor monitor;
  TrackPoint last;

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
  SE3 T_world_odom_;
  int scans_ = 0;
};

SavedState state_of(const Journey& journey) {
  SavedState state;
  state.boot = "b";
  state.stamp = journey.last.stamp;
  state.T_odom_base = journey.last.T_odom_base;
  return state;
}

class Resumed : public testing::TestWithParam<support::Scene> {};

TEST_P(Resumed, TheTrajectoryGoesOn) {
  const support::Scene& scene = GetParam();
  support::TemporaryFolder folder;
  Journey journey(scene, 5.0);
  Generations generations(folder.path(), journey.monitor);
  Vector6 before;
  {
    Robot robot(journey.config, journey.workers, journey.workers, journey.monitor);
    for (int i = 0; i < 40; ++i) journey.step(robot);
    ASSERT_TRUE(generations.save(robot.map(), state_of(journey)));
    for (int i = 0; i < 8; ++i) journey.step(robot);
    ASSERT_TRUE(generations.save_state(state_of(journey)));
    before = journey.error();
  }
  journey.miss(12);  // dead: 0.2 s at full speed, then braking, then at rest

  Generations again(folder.path(), journey.monitor);
  const auto saved = again.load(Time{});
  ASSERT_TRUE(saved);
  Robot robot(journey.config, journey.workers, journey.workers, journey.monitor,
              {*saved->map, saved->state.T_odom_base, saved->state.stamp});
  journey.step(robot);
  const Vector6 first = journey.error();
  EXPECT_FALSE(journey.last.lost);
  for (int i = 0; i < 15; ++i) journey.step(robot);
  const Vector6 later = journey.error();
  EXPECT_FALSE(journey.last.lost);
  std::printf("%-18s %10.3f m %7.2f deg %14.3f m %7.2f deg %12.3f m %6.2f deg\n", scene.name.c_str(),
              before.head<3>().norm(), before.tail<3>().norm() * 57.3, first.head<3>().norm(),
              first.tail<3>().norm() * 57.3, later.head<3>().norm(), later.tail<3>().norm() * 57.3);
  EXPECT_LT(first.head<3>().norm(), before.head<3>().norm() + 0.10);
  EXPECT_LT(first.tail<3>().norm(), before.tail<3>().norm() + 0.02);
  EXPECT_LT(later.head<3>().norm(), before.head<3>().norm() + 0.10);
  EXPECT_LT(later.tail<3>().norm(), before.tail<3>().norm() + 0.02);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Resumed,
                         testing::Values(support::corridor(), support::lobby(), support::office(), support::carpark()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace cairn
