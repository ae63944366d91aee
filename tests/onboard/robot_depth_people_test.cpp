// SPDX-License-Identifier: Apache-2.0
// Somebody walks past a robot that looks for people in the clouds of its depth camera.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "onboard/robot.hpp"
#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn {
namespace {

using people::test::Cylinder;
using ::testing::HasSubstr;

constexpr double kHigh = 0.6;  // m: of both sensors above base_link, which is on the ground

Time at(double seconds) { return Time{from_seconds(seconds)}; }

/// The ground, a wall 8 m ahead, and somebody, as seen in a field of view of 90° by 50°; in base_link.
std::vector<Eigen::Vector3f> seen(const Cylinder& body) {
  const Eigen::Vector3d eye(0, 0, kHigh);
  std::vector<Eigen::Vector3f> points;
  for (double up = -25; up <= 25; ++up)
    for (double around = -45; around <= 45; around += 0.5) {
      const double pitch = up * M_PI / 180, yaw = around * M_PI / 180;
      const Eigen::Vector3d ray(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
      double range = std::min(8 / ray.x(), people::test::meet(body, eye, ray));
      if (ray.z() < 0) range = std::min(range, -eye.z() / ray.z());
      points.push_back((eye + range * ray).cast<float>());
    }
  return points;
}

Cylinder walker_at(double t) { return {{3, -3 + 1.2 * (t - 10)}, 0.22, 1.75}; }

RobotConfig config(bool by_depth) {
  RobotConfig c;
  c.T_base_lidar = SE3::from_xyz_rpy((Vector6() << 0, 0, kHigh, 0, 0, 0).finished());
  c.depth = mapping::SensorTrust{.prob_hit = 0.65, .prob_miss = 0.45, .max_range_m = 8};
  c.people = PeopleSetup{.config = {}, .eyes = {}, .by_depth = by_depth};
  const auto camera = cameras::CameraModel::create(
      {.width = 200, .height = 200, .fx = 100, .fy = 100, .cx = 99.5, .cy = 99.5, .distortion = {}});
  c.people->eyes.push_back({people::Eye::kVisible, camera.value(), c.T_base_lidar});
  return c;
}

class RobotWithDepth : public ::testing::Test {
 protected:
  static LocatedScan scan_at(double t) {
    LocatedScan scan;
    scan.stamp = at(t);
    scan.points_base = seen(walker_at(t));
    return scan;
  }
  static DepthCloud cloud_at(double t) {
    return {.stamp = at(t), .origin_base = {0, 0, static_cast<float>(kHigh)}, .points_base = seen(walker_at(t))};
  }
  /// Five scans and five clouds a second, the clouds in the middle. Returns how often somebody was followed.
  static std::size_t walk_past(Robot& robot, double seconds = 5) {
    std::size_t followed = 0;
    for (int i = 0; 0.2 * i < seconds; ++i) {
      const LocatedScan scan = scan_at(10 + 0.2 * i);
      robot.announce(scan);
      const auto put = robot.extend_map(cloud_at(9.9 + 0.2 * i));
      EXPECT_EQ(put && *put, i > 0);
      EXPECT_TRUE(robot.extend_map(scan));
      followed += robot.people().size();
    }
    return followed;
  }
  /// Occupied voxels where the walker was.
  static std::size_t left_in_map(const Robot& robot) {
    std::size_t left = 0;
    for (auto leaf = robot.map().begin_leafs(); leaf != robot.map().end_leafs(); ++leaf)
      if (robot.map().isNodeOccupied(*leaf) && leaf.getZ() > 0.3 && leaf.getX() > 2 && leaf.getX() < 4) ++left;
    return left;
  }

  Monitor monitor_;
  Workers one_{1}, another_{1};
  Robot by_depth_{config(true), one_, another_, monitor_};
};

TEST_F(RobotWithDepth, FollowsWhoWalksPastAndLeavesThemOutOfTheMap) {
  EXPECT_GT(walk_past(by_depth_), 15U);
  EXPECT_LE(left_in_map(by_depth_), 4U) << "of clouds and scans";
  for (const people::Person& person : by_depth_.people()) EXPECT_EQ(person.stamp, at(14.7)) << "of the last cloud";
}

TEST_F(RobotWithDepth, ACloudBeforeTheFirstScanIsNotLate) {
  by_depth_.announce(scan_at(10));
  EXPECT_TRUE(by_depth_.before_map(at(9.9)));
  EXPECT_FALSE(by_depth_.before_map(at(10)));
}

TEST_F(RobotWithDepth, LooksForNobodyInItsScans) {
  Robot by_scans{config(false), one_, another_, monitor_};
  for (int i = 0; i < 15; ++i)
    for (Robot* robot : {&by_depth_, &by_scans}) ASSERT_TRUE(robot->extend_map(scan_at(10 + 0.2 * i)));
  EXPECT_TRUE(by_depth_.people().empty());
  EXPECT_EQ(by_scans.people().size(), 1U);
}

/// Its clouds reach nobody in the map, so all that takes a ghost out of it is what is taken back.
TEST_F(RobotWithDepth, TakesBackWhatScansPutIntoTheMapBefore) {
  RobotConfig near_sighted = config(true);
  near_sighted.depth->max_range_m = 1;
  Robot robot{near_sighted, one_, another_, monitor_};
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(robot.extend_map(scan_at(10 + 0.2 * i)));
  const std::size_t ghosts = left_in_map(robot);
  ASSERT_GT(ghosts, 5U);
  for (int i = 0; i < 12; ++i) {
    robot.announce(scan_at(10.8 + 0.2 * i));
    (void)robot.extend_map(cloud_at(10.1 + 0.2 * i));
  }
  EXPECT_EQ(robot.people().size(), 1U);
  EXPECT_LT(left_in_map(robot), ghosts / 2);
}

TEST_F(RobotWithDepth, BoxesWaitForTheCloudOfTheirPictureAndNotForEver) {
  walk_past(by_depth_, 1);  // the last scan is of 10.8 s, the last cloud of 10.7 s
  Detections boxes{.stamp = at(10.75), .width = 200, .height = 200, .found = {}};
  EXPECT_EQ(by_depth_.see_people(people::Eye::kVisible, boxes).value_or(true), false);
  ASSERT_TRUE(by_depth_.extend_map(scan_at(11.0)));
  EXPECT_EQ(by_depth_.see_people(people::Eye::kVisible, boxes).value_or(true), false);
  ASSERT_TRUE(by_depth_.extend_map(scan_at(11.2)));
  EXPECT_EQ(by_depth_.see_people(people::Eye::kVisible, boxes).value_or(false), true) << "the one before will do";
  boxes.stamp = at(11.1);
  for (const double t : {11.4, 11.6}) ASSERT_TRUE(by_depth_.extend_map(scan_at(t)));
  const auto apart = by_depth_.see_people(people::Eye::kVisible, boxes);
  ASSERT_FALSE(apart);
  EXPECT_THAT(to_string(apart.error()), HasSubstr("no depth pictures around the picture"));
}

TEST_F(RobotWithDepth, TheCloudAfterThePictureIsEnough) {
  walk_past(by_depth_, 1);
  const Detections boxes{.stamp = at(10.75), .width = 200, .height = 200, .found = {}};
  ASSERT_TRUE(by_depth_.extend_map(scan_at(11.0)));
  ASSERT_TRUE(by_depth_.extend_map(cloud_at(10.8)));
  EXPECT_EQ(by_depth_.see_people(people::Eye::kVisible, boxes).value_or(false), true);
}

}  // namespace
}  // namespace cairn
