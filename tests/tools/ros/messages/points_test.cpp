// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/points.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace cairn::ros {
namespace {

client::ScanMessage scan_of(std::vector<Eigen::Vector3f> points) {
  client::ScanMessage scan;
  scan.stamp = Time{Duration{7}};
  scan.points_base = std::move(points);
  return scan;
}

float coordinate(const PointCloud2& cloud, std::uint32_t point, std::uint32_t field) {
  float value = 0;
  std::memcpy(&value, cloud.data._buffer + point * cloud.point_step + cloud.fields._buffer[field].offset, sizeof value);
  return value;
}

TEST(RosPoints, AreFoundByTheirFields) {
  Arena arena;
  const PointCloud2 cloud = points_of(scan_of({{1, 2, 3}, {-4, 5.5F, 6}}), Frames("a/"), Duration{}, arena);
  EXPECT_STREQ(cloud.header.frame_id, "a/base_link");
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_EQ(cloud.width, 2U);
  EXPECT_EQ(cloud.point_step, 12U);
  EXPECT_EQ(cloud.row_step, 24U);
  EXPECT_EQ(cloud.data._length, 24U);
  EXPECT_TRUE(cloud.is_dense);
  EXPECT_FALSE(cloud.is_bigendian);
  ASSERT_EQ(cloud.fields._length, 3U);
  EXPECT_STREQ(cloud.fields._buffer[2].name, "z");
  EXPECT_EQ(cloud.fields._buffer[2].datatype, 7U);
  EXPECT_EQ(cloud.fields._buffer[2].count, 1U);
  EXPECT_EQ(coordinate(cloud, 0, 2), 3);
  EXPECT_EQ(coordinate(cloud, 1, 0), -4);
  EXPECT_EQ(coordinate(cloud, 1, 1), 5.5F);
}

TEST(RosPoints, SayWhetherOneIsNone) {
  Arena arena;
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(points_of(scan_of({{1, 2, 3}, {none, 0, 0}}), Frames(), Duration{}, arena).is_dense);
  const PointCloud2 empty = points_of(scan_of({}), Frames(), Duration{}, arena);
  EXPECT_EQ(empty.width, 0U);
  EXPECT_EQ(empty.data._length, 0U);
}

TEST(RosPoints, OfAThermalCloudHaveTemperatures) {
  Arena arena;
  client::ThermalMessage cloud{.stamp = Time{Duration{7}}, .celsius = true};
  cloud.points = {{{1, 2, 3}, 20.5F}, {{4, 5, 6}, 36}};
  const PointCloud2 message = points_of(cloud, Frames("a/"), Duration{}, arena);
  EXPECT_STREQ(message.header.frame_id, "a/base_link");
  EXPECT_EQ(message.width, 2U);
  EXPECT_EQ(message.point_step, 16U);
  EXPECT_EQ(message.data._length, 32U);
  ASSERT_EQ(message.fields._length, 4U);
  EXPECT_STREQ(message.fields._buffer[3].name, "temperature");
  EXPECT_EQ(coordinate(message, 0, 3), 20.5F);
  EXPECT_EQ(coordinate(message, 1, 2), 6);
  cloud.celsius = false;
  EXPECT_STREQ(points_of(cloud, Frames(), Duration{}, arena).fields._buffer[3].name, "counts");
}

}  // namespace
}  // namespace cairn::ros
