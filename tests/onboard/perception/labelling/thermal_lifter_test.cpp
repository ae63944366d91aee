// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/thermal_lifter.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/onboard/perception/labelling/scene.hpp"
#include "tests/support/allocation_count.hpp"

namespace cairn::labelling {
namespace {

float celsius_of(std::uint8_t class_id) {
  if (class_id == test::kCar) return 40;
  return class_id == test::kRoad ? 20 : 15;
}

/// What small_camera() would measure from there.
Image warmth_from(const SE3& T_odom_base) {
  const LabelImage labels = test::picture_from(T_odom_base);
  Image values;
  values.resize(PixelFormat::kCelsius, labels.width, labels.height);
  for (std::size_t i = 0; i < labels.classes.size(); ++i) {
    const float value = celsius_of(labels.classes[i]);
    std::memcpy(&values.bytes[i * sizeof value], &value, sizeof value);
  }
  return values;
}

SE3 base_at(double x, double y, double yaw) { return SE3::from_xyz_rpy((Vector6() << x, y, 0, 0, 0, yaw).finished()); }

std::vector<ThermalPoint> lifted(const Image& values, const PlacedScan& scan, const SE3& T_odom_base,
                                 const LabellingConfig& config = {}) {
  ThermalLifter lifter(test::small_camera(), test::mount(), config);
  std::vector<ThermalPoint> points;
  const auto done = lifter.lift(values.view(), scan, T_odom_base, points);
  EXPECT_TRUE(done) << to_string(done.error());
  return points;
}

/// Points whose value is not that of where they lie.
std::size_t wrong(const std::vector<ThermalPoint>& points, const SE3& T_odom_base) {
  std::size_t count = 0;
  for (const ThermalPoint& p : points)
    count += p.value != celsius_of(test::true_class(T_odom_base * p.point_base.cast<double>())) ? 1 : 0;
  return count;
}

TEST(ThermalLifter, PointsAreInBaseLinkAtTheExposureWithTheValueOfTheirPixel) {
  PlacedScan scan;
  scan.T_odom_base = base_at(1, 2, 0.3);
  scan.points_base = {{6, 0, 1}, {-5, 0, 1}};
  const SE3 T_exposure = base_at(0.9, 2.05, 0.28);
  Image values = warmth_from({});
  std::fill(values.bytes.begin(), values.bytes.end(), std::byte{0});
  const auto points = lifted(values, scan, T_exposure);
  ASSERT_EQ(points.size(), 1U) << "the other lies behind";
  EXPECT_EQ(points[0].value, 0);
  const Eigen::Vector3d expected = T_exposure.inverse() * (scan.T_odom_base * Eigen::Vector3d(6, 0, 1));
  EXPECT_LT((points[0].point_base.cast<double>() - expected).norm(), 1e-5);
}

TEST(ThermalLifter, WhatTheCameraSeesHasItsTemperature) {
  const SE3 T_scan = base_at(0.3, 0, 0.05), T_exposure = base_at(0, 0.1, -0.04);
  const auto points = lifted(warmth_from(T_exposure), test::scan_from(T_scan), T_exposure);
  EXPECT_GT(points.size(), 5000U);
  EXPECT_LT(100 * wrong(points, T_exposure), points.size()) << "the rims of the car alone";
}

TEST(ThermalLifter, WhatIsHiddenFromTheCameraGetsNoTemperature) {
  const SE3 T_scan = base_at(0, 0, 0), T_exposure = base_at(0, 0, 0);
  LabellingConfig all;
  all.occlusion_m = 100;
  const PlacedScan scan = test::scan_from(T_scan);
  const Image values = warmth_from(T_exposure);
  const auto without = lifted(values, scan, T_exposure, all), with = lifted(values, scan, T_exposure);
  EXPECT_GT(wrong(without, T_exposure), 4 * wrong(with, T_exposure)) << "the wall behind the car's left edge";
}

TEST(ThermalLifter, FartherThanTheLimitNothingIsMeasured) {
  LabellingConfig near;
  near.farthest_m = 8;
  const auto points = lifted(warmth_from({}), test::scan_from({}), {}, near);
  ASSERT_FALSE(points.empty());
  for (const ThermalPoint& p : points) ASSERT_LT(p.point_base.norm(), 9.5);
}

TEST(ThermalLifter, CountsStayCounts) {
  Image counts;
  counts.resize(PixelFormat::kMono16, 320, 240);
  const std::uint16_t count = 30'515;
  for (std::size_t at = 0; at < counts.bytes.size(); at += 2) std::memcpy(&counts.bytes[at], &count, 2);
  const auto points = lifted(counts, test::scan_from({}), {});
  ASSERT_FALSE(points.empty());
  for (const ThermalPoint& p : points) ASSERT_EQ(p.value, 30'515);
}

TEST(ThermalLifter, APictureOfAnotherSizeOrKindIsRefused) {
  ThermalLifter lifter(test::small_camera(), test::mount(), {});
  std::vector<ThermalPoint> points(3);
  Image other;
  other.resize(PixelFormat::kCelsius, 160, 120);
  const auto size = lifter.lift(other.view(), test::scan_from({}), {}, points);
  ASSERT_FALSE(size);
  EXPECT_EQ(size.error().code, Errc::kMalformed);
  EXPECT_TRUE(points.empty());
  other.resize(PixelFormat::kMono8, 320, 240);
  EXPECT_FALSE(lifter.lift(other.view(), test::scan_from({}), {}, points));
}

TEST(ThermalLifter, TheSecondScanAllocatesNothing) {
  ThermalLifter lifter(test::small_camera(), test::mount(), {});
  const PlacedScan scan = test::scan_from({});
  const Image values = warmth_from({});
  std::vector<ThermalPoint> points, again;
  ASSERT_TRUE(lifter.lift(values.view(), scan, {}, points));
  again.reserve(points.size());
  const std::size_t before = support::allocation_count();
  ASSERT_TRUE(lifter.lift(values.view(), scan, {}, again));
  EXPECT_EQ(support::allocation_count(), before);
  EXPECT_EQ(again.size(), points.size());
}

}  // namespace
}  // namespace cairn::labelling
