// SPDX-License-Identifier: Apache-2.0
// Pictures of another time than the scans around them.
#include <gmock/gmock.h>

#include "onboard/robot.hpp"

namespace cairn {
namespace {

using ::testing::HasSubstr;

/// A robot that stands for three seconds and maps what it sees 5 m ahead, from t = 10 s on.
class RobotPictures : public ::testing::Test {
 protected:
  RobotPictures() {
    for (int i = 0; i < 30; ++i) EXPECT_TRUE(robot_.extend_map(scan_at(10 + 0.1 * i)));
  }
  static LocatedScan scan_at(double t) {
    LocatedScan scan;
    scan.stamp = Time{from_seconds(t)};
    scan.points_base = {{5, 0, 0}, {5, 0.2F, 0}};
    return scan;
  }
  Result<std::optional<SE3>> cloud_at(double t) {
    DepthCloud cloud;
    cloud.stamp = Time{from_seconds(t)};
    cloud.points_base = {{2, 0, 0}};
    return robot_.extend_map(cloud);
  }

  static RobotConfig config() {
    RobotConfig c;
    c.depth = mapping::SensorTrust{};
    return c;
  }
  Monitor monitor_;
  Workers one_{1}, another_{1};
  Robot robot_{config(), one_, another_, monitor_};
};

TEST_F(RobotPictures, OfTheLastSecondAreUsed) {
  const auto used = cloud_at(12.45);
  ASSERT_TRUE(used) << to_string(used.error());
  EXPECT_TRUE(*used);
}

TEST_F(RobotPictures, MakeTheMapAloneWhereTheLidarDoesNot) {
  RobotConfig by_depth = config();
  by_depth.lidar_maps = false;
  Robot robot{by_depth, one_, another_, monitor_};
  const auto is_free_or_occupied = [&](double x) { return robot.map().search(x, 0.05, 0.05) != nullptr; };
  ASSERT_TRUE(robot.extend_map(scan_at(10)));
  ASSERT_TRUE(robot.extend_map(scan_at(10.1)));
  EXPECT_EQ(robot.map().size(), 0U);
  DepthCloud cloud{.stamp = Time{from_seconds(10.05)}, .points_base = {{2.05F, 0.05F, 0.05F}}};
  EXPECT_TRUE(robot.extend_map(cloud).value_or(std::nullopt));
  EXPECT_TRUE(is_free_or_occupied(2.05));
  EXPECT_FALSE(is_free_or_occupied(4.95));
}

TEST_F(RobotPictures, ThatAreTooLateSaySo) {
  const auto late = cloud_at(10.95);  // two seconds before the newest scan
  ASSERT_FALSE(late);
  EXPECT_THAT(to_string(late.error()), HasSubstr("the picture came too late"));
  EXPECT_FALSE(robot_.before_map(Time{from_seconds(10.95)}));
}

TEST_F(RobotPictures, OfTheTimeBeforeTheMapAreKnown) {
  EXPECT_TRUE(robot_.before_map(Time{from_seconds(9.95)}));
  const auto early = cloud_at(9.95);
  ASSERT_FALSE(early);
  EXPECT_THAT(to_string(early.error()), HasSubstr("no scans around the picture"));
  const Robot empty{config(), one_, another_, monitor_};
  EXPECT_FALSE(empty.before_map(Time{from_seconds(9.95)})) << "its map may still begin before";
}

TEST_F(RobotPictures, ThatAreNewerThanEveryScanWait) {
  const auto waits = cloud_at(12.95);
  ASSERT_TRUE(waits);
  EXPECT_FALSE(*waits);
}

}  // namespace
}  // namespace cairn
