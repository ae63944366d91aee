// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/located_scans.hpp"

#include <gtest/gtest.h>

#include "tests/support/allocation_count.hpp"

namespace cairn::labelling {
namespace {

using Eigen::Vector3f;

Time at_ms(std::int64_t ms) { return Time(std::chrono::milliseconds(ms)); }

const Vector6 kScrew = (Vector6() << 1.5, 0.2, -0.1, 0.05, -0.1, 0.8).finished();  // m/s, rad/s

SE3 on_the_screw(double s) {
  return SE3::from_xyz_rpy((Vector6() << 3, 4, 0, 0, 0, 2).finished()) * SE3::exp(s * kScrew);
}

/// Scans at 0, 100, … ms along a screw motion.
LocatedScans drive(int scans) {
  LocatedScans located;
  for (int i = 0; i < scans; ++i) {
    const std::vector<Vector3f> points(4, Vector3f(static_cast<float>(i), 0, 0));
    EXPECT_TRUE(located.add(at_ms(100 * i), on_the_screw(0.1 * i), kScrew, 0, points));
  }
  return located;
}

double distance(const SE3& a, const SE3& b) { return (a.inverse() * b).log().norm(); }

TEST(LocatedScans, APoseBetweenTwoScansLiesOnTheScrewBetweenThem) {
  const LocatedScans scans = drive(6);
  for (int ms = 0; ms <= 500; ms += 7) EXPECT_LT(distance(*scans.pose_at(at_ms(ms)), on_the_screw(1e-3 * ms)), 1e-9);
  EXPECT_LT((*scans.twist_at(at_ms(234)) - kScrew).norm(), 1e-9);
}

TEST(LocatedScans, BeyondTheNewestScanOnlyWhenAskedAndNotFar) {
  const LocatedScans scans = drive(3);
  EXPECT_TRUE(scans.pose_at(at_ms(200)));
  EXPECT_FALSE(scans.pose_at(at_ms(201)));
  EXPECT_LT(distance(*scans.pose_at(at_ms(350), LocatedScans::Beyond::kExtrapolate), on_the_screw(0.35)), 1e-9);
  EXPECT_FALSE(scans.pose_at(at_ms(351), LocatedScans::Beyond::kExtrapolate));
  EXPECT_FALSE(scans.pose_at(at_ms(-1), LocatedScans::Beyond::kExtrapolate));
  EXPECT_FALSE(scans.twist_at(at_ms(-1)));
  EXPECT_FALSE(LocatedScans().pose_at(at_ms(0), LocatedScans::Beyond::kExtrapolate));
}

TEST(LocatedScans, NothingIsInterpolatedOverALongGap) {
  LocatedScans scans;
  scans.add(at_ms(0), SE3(), kScrew, 0, {});
  scans.add(at_ms(600), SE3(), kScrew, 0, {});
  EXPECT_FALSE(scans.pose_at(at_ms(300)));
  EXPECT_TRUE(scans.pose_at(at_ms(600)));
}

TEST(LocatedScans, TheNearestScanIsFound) {
  const LocatedScans scans = drive(4);
  EXPECT_EQ(scans.nearest(at_ms(-50))->stamp, at_ms(0));
  EXPECT_EQ(scans.nearest(at_ms(149))->stamp, at_ms(100));
  EXPECT_EQ(scans.nearest(at_ms(150))->stamp, at_ms(100));
  EXPECT_EQ(scans.nearest(at_ms(151))->stamp, at_ms(200));
  EXPECT_EQ(scans.nearest(at_ms(9000))->stamp, at_ms(300));
  EXPECT_EQ(scans.nearest(at_ms(200))->points_base[0].x(), 2);
  EXPECT_EQ(LocatedScans().nearest(at_ms(0)), nullptr);
}

TEST(LocatedScans, ANewEpochDropsWhatWasBefore) {
  LocatedScans scans = drive(4);
  EXPECT_TRUE(scans.add(at_ms(250), SE3(), kScrew, 1, {}));
  EXPECT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans.nearest(at_ms(0))->epoch, 1U);
  EXPECT_FALSE(scans.pose_at(at_ms(200)));
}

TEST(LocatedScans, AScanThatIsNotLaterIsRefused) {
  LocatedScans scans = drive(4);
  EXPECT_FALSE(scans.add(at_ms(300), SE3(), kScrew, 0, {}));
  EXPECT_FALSE(scans.add(at_ms(100), SE3(), kScrew, 0, {}));
  EXPECT_EQ(scans.size(), 4U);
  EXPECT_LT(distance(*scans.pose_at(at_ms(300)), on_the_screw(0.3)), 1e-9);
}

TEST(LocatedScans, AgeCountAndPointsAreBounded) {
  EXPECT_EQ(drive(40).size(), 11U) << "one second";
  LocatedScans few({.age = std::chrono::seconds(100), .scans = 3});
  LocatedScans small({.age = std::chrono::seconds(100), .points = 100});
  const std::vector<Vector3f> points(40);
  for (int i = 0; i < 9; ++i) {
    few.add(at_ms(100 * i), SE3(), kScrew, 0, points);
    small.add(at_ms(100 * i), SE3(), kScrew, 0, points);
  }
  EXPECT_EQ(few.size(), 3U);
  EXPECT_EQ(few[0].stamp, at_ms(600));
  EXPECT_EQ(small.size(), 2U);
  small.add(at_ms(900), SE3(), kScrew, 0, std::vector<Vector3f>(500));
  EXPECT_EQ(small.size(), 1U) << "the newest always stays";
  small.add(at_ms(1000), SE3(), kScrew, 0, points);
  EXPECT_EQ(small.size(), 1U);
}

TEST(LocatedScans, NothingIsAllocatedOnceMemoryIsThere) {
  LocatedScans scans;
  const std::vector<Vector3f> points(1000);
  const auto add = [&](int i) { scans.add(at_ms(100 * i), SE3(), kScrew, 0, points); };
  for (int i = 0; i < 64; ++i) add(i);
  const std::size_t before = support::allocation_count();
  for (int i = 64; i < 200; ++i) add(i);
  EXPECT_EQ(support::allocation_count(), before);
}

}  // namespace
}  // namespace cairn::labelling
