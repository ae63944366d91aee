// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/thermal_joiner.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/onboard/perception/labelling/scene.hpp"

namespace cairn::labelling {
namespace {

using std::chrono::milliseconds;

Time at_ms(int ms) { return Time{milliseconds(ms)}; }

/// A picture of one temperature.
Image picture(int ms, float celsius, int width = 320) {
  Image values;
  values.resize(PixelFormat::kCelsius, width, 240);
  for (std::size_t at = 0; at < values.bytes.size(); at += sizeof celsius)
    std::memcpy(&values.bytes[at], &celsius, sizeof celsius);
  values.stamp = at_ms(ms);
  return values;
}

/// The robot drives 1 m/s along x, towards a point 20 m ahead.
class Joining : public ::testing::Test {
 protected:
  void scan(int ms, std::uint32_t epoch = 1) {
    const double x = 1e-3 * ms;
    const std::vector<Eigen::Vector3f> points{{static_cast<float>(20 - x), 0.3F, 1.2F}};
    joiner_.add_scan(at_ms(ms), SE3::from_xyz_rpy((Vector6() << x, 0, 0, 0, 0, 0).finished()), Vector6::Zero(), epoch,
                     points);
  }
  ThermalJoiner joiner_{ThermalLifter(test::small_camera(), test::mount(), {})};
  ThermalCloud cloud_;
};

TEST_F(Joining, APictureWaitsForTheScanAfterIt) {
  scan(0);
  joiner_.add_picture(picture(40, 30));
  EXPECT_FALSE(joiner_.next(cloud_).value());
  scan(100);
  ASSERT_TRUE(joiner_.next(cloud_).value());
  EXPECT_EQ(cloud_.stamp, at_ms(40));
  EXPECT_TRUE(cloud_.celsius);
  EXPECT_EQ(cloud_.epoch, 1U);
  EXPECT_NEAR(cloud_.T_odom_base.translation().x(), 0.04, 1e-9);
  ASSERT_EQ(cloud_.points.size(), 1U);
  EXPECT_NEAR(cloud_.points[0].point_base.x(), 19.96, 1e-5);
  EXPECT_EQ(cloud_.points[0].value, 30);
  EXPECT_FALSE(joiner_.next(cloud_).value());
}

TEST_F(Joining, PicturesComeInTheirOrder) {
  scan(0);
  for (const int ms : {10, 50, 90}) joiner_.add_picture(picture(ms, static_cast<float>(ms)));
  scan(100);
  for (const int ms : {10, 50, 90}) {
    ASSERT_TRUE(joiner_.next(cloud_).value());
    EXPECT_EQ(cloud_.stamp, at_ms(ms));
    ASSERT_EQ(cloud_.points.size(), 1U);
    EXPECT_EQ(cloud_.points[0].value, static_cast<float>(ms));
  }
}

TEST_F(Joining, PicturesWithoutScansAroundThemAreLeftOut) {
  joiner_.add_picture(picture(10, 30));
  scan(100);
  joiner_.add_picture(picture(500, 31));
  scan(1000);
  EXPECT_FALSE(joiner_.next(cloud_).value()) << "before all scans, and in a gap";
  joiner_.add_picture(picture(1050, 32));
  scan(1100);
  ASSERT_TRUE(joiner_.next(cloud_).value());
  EXPECT_EQ(cloud_.stamp, at_ms(1050));
}

TEST_F(Joining, OfTooManyPicturesTheOldestAreLeftOut) {
  scan(0);
  for (int i = 0; i < static_cast<int>(ThermalJoiner::kWaiting) + 2; ++i) joiner_.add_picture(picture(10 + i, 30));
  scan(100);
  std::size_t joined = 0;
  for (; joiner_.next(cloud_).value(); ++joined) EXPECT_EQ(cloud_.stamp, at_ms(12 + static_cast<int>(joined)));
  EXPECT_EQ(joined, ThermalJoiner::kWaiting);
}

TEST_F(Joining, APictureThatDoesNotFitIsAnErrorAndTheNextOneGoesOn) {
  scan(0);
  joiner_.add_picture(picture(10, 30, 160));
  joiner_.add_picture(picture(20, 30));
  scan(100);
  EXPECT_FALSE(joiner_.next(cloud_));
  ASSERT_TRUE(joiner_.next(cloud_));
  EXPECT_EQ(cloud_.stamp, at_ms(20));
}

TEST_F(Joining, AnotherEpochForgetsTheScansBefore) {
  scan(0);
  joiner_.add_picture(picture(50, 30));
  scan(100, 2);
  EXPECT_FALSE(joiner_.next(cloud_).value());
}

}  // namespace
}  // namespace cairn::labelling
