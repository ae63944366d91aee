// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/clouds/scan.hpp"

#include <limits>

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

std::vector<Eigen::Vector3f> some_points(std::size_t count) {
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(static_cast<float>(i), -1.5F, 0.25F);
  return points;
}

ScanPart some_part() {
  ScanPart part;
  part.stamp = Time{Duration{77}};
  part.lost = true;
  part.epoch = 3;
  part.T_odom_base = SE3::from_xyz_rpy((Vector6() << 1, 2, 3, 0, 0, 1).finished());
  return part;
}

TEST(ScanPart, PartsMakeTheScan) {
  const auto points = some_points(6000);
  ScanPart part = some_part();
  std::vector<Eigen::Vector3f> got;
  int parts = 0;
  for (; part.first < points.size(); ++parts) {
    std::vector<std::byte> body;
    const std::uint32_t taken = encode(part, points, body);
    ASSERT_LE(body.size(), Record::kMaxBody);
    const auto decoded = decode_scan(body);
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    EXPECT_EQ(decoded->stamp, part.stamp);
    EXPECT_TRUE(decoded->lost);
    EXPECT_EQ(decoded->epoch, 3U);
    EXPECT_LT((decoded->T_odom_base.inverse() * part.T_odom_base).log().norm(), 1e-12);
    EXPECT_EQ(decoded->total, points.size());
    EXPECT_EQ(decoded->first, part.first);
    got.insert(got.end(), decoded->points_base.begin(), decoded->points_base.end());
    part.first += taken;
  }
  EXPECT_EQ(parts, 3);
  EXPECT_EQ(got, points);
}

TEST(ScanPart, IsExact) {
  std::vector<std::byte> body;
  encode(some_part(), some_points(3), body);
  test::expect_exact(body, decode_scan);
  body.clear();
  EXPECT_EQ(encode(some_part(), {}, body), 0U);
  EXPECT_TRUE(decode_scan(body));
}

TEST(ScanPart, PointsAreFinite) {
  auto points = some_points(3);
  points[1].y() = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::byte> body;
  encode(some_part(), points, body);
  EXPECT_FALSE(decode_scan(body));
}

}  // namespace
}  // namespace cairn::clients
