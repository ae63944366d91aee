// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/scan_preparation.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cairn::odometry {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Scan scan_of(std::vector<Eigen::Vector3f> points, double seconds = 0.1) {
  Scan scan;
  scan.valid = {Time{from_seconds(5)}, Time{from_seconds(5 + seconds)}};
  for (std::size_t i = 0; i < points.size(); ++i)
    scan.cloud.push_back(points[i], 0, static_cast<std::uint32_t>(10'000'000 * i), 0, ReturnType::kStrongest);
  return scan;
}

TEST(ScanPreparation, KeepsTheFinitePointsInTheirOrderWithTheirAges) {
  ScanPreparation preparation({});
  const PreparedScan& out =
      preparation.prepare(scan_of({{1, 0, 0}, {kNan, 0, 0}, {3, 0, 0}, {0, kInfinity, 0}, {5, 0, 0}}));
  EXPECT_EQ(out.stamp, Time{from_seconds(5.1)});
  EXPECT_DOUBLE_EQ(out.duration_s, 0.1);
  ASSERT_EQ(out.points_lidar.size(), 3U);
  const std::vector<float> ages{0.10F, 0.08F, 0.06F};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(out.points_lidar[i].x(), static_cast<float>(2 * i + 1));
    EXPECT_NEAR(out.age_s[i], ages[i], 1e-7F) << i;
  }
}

TEST(ScanPreparation, NamesThePointsThatAreNeitherTooNearNorTooFar) {
  OdometryConfig config;
  config.min_range_m = 2;
  config.max_range_m = 4;
  ScanPreparation preparation(config);
  const PreparedScan& out =
      preparation.prepare(scan_of({{1.9F, 0, 0}, {0, 2, 0}, {kNan, 0, 0}, {0, 0, -3}, {4, 0, 0}, {4.1F, 0, 0}}));
  EXPECT_EQ(out.points_lidar.size(), 5U) << "a point out of range is still part of the scan";
  EXPECT_EQ(out.in_range, (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST(ScanPreparation, NoPointIsOlderThanASlowRevolution) {
  ScanPreparation preparation({});
  const PreparedScan& out = preparation.prepare(scan_of({{1, 0, 0}, {2, 0, 0}}, 7));
  EXPECT_EQ(out.duration_s, 0.25);
  for (const float age : out.age_s) EXPECT_EQ(age, 0.25F);
  Scan late = scan_of({{1, 0, 0}});
  late.cloud.offset_ns[0] = 4'000'000'000U;
  EXPECT_EQ(preparation.prepare(late).age_s[0], 0) << "fired after the end";
}

TEST(ScanPreparation, PointsOfADeskewedScanHaveOneAge) {
  Scan scan = scan_of({{1, 0, 0}, {2, 0, 0}});
  scan.deskewed = true;
  scan.cloud.offset_ns.clear();
  ASSERT_TRUE(ScanPreparation::check(scan));
  ScanPreparation preparation({});
  const PreparedScan& out = preparation.prepare(scan);
  EXPECT_EQ(out.duration_s, 0);
  EXPECT_EQ(out.age_s, (std::vector<float>{0, 0}));
}

TEST(ScanPreparation, RefusesTooManyPointsAndPointsWithoutAFiringTime) {
  Scan scan = scan_of({{1, 0, 0}});
  EXPECT_TRUE(ScanPreparation::check(scan));
  scan.cloud.offset_ns.clear();
  EXPECT_EQ(ScanPreparation::check(scan).error().code, Errc::kMalformed);
  scan.cloud.xyz.resize(ScanPreparation::kMaxPoints + 1);
  EXPECT_EQ(ScanPreparation::check(scan).error().code, Errc::kLimit);
}

TEST(ScanPreparation, AScanThatWasPlacedBeforeGoesBackIntoTheSensorsFrame) {
  const SE3 mount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0.02, -0.05, 0.3).finished());
  const PlacedScan placed{
      .stamp = Time{from_seconds(3)}, .T_odom_base = {}, .points_base = {{0.1F, 0, 0}, {200, 1, 2}}};
  ScanPreparation preparation({});
  const PreparedScan& out = preparation.prepare(placed, mount);
  EXPECT_EQ(out.stamp, placed.stamp);
  EXPECT_EQ(out.duration_s, 0);
  EXPECT_EQ(out.in_range, (std::vector<std::uint32_t>{0, 1})) << "their range was judged when they were placed";
  EXPECT_EQ(out.age_s, (std::vector<float>{0, 0}));
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Vector3d back = mount * out.points_lidar[i].cast<double>();
    EXPECT_LT((back - placed.points_base[i].cast<double>()).norm(), 1e-4) << i;
  }
}

}  // namespace
}  // namespace cairn::odometry
