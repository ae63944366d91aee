// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/clouds/thermal.hpp"

#include <limits>

#include "tests/drivers/clients/messages/message_checks.hpp"

namespace cairn::clients {
namespace {

std::vector<ThermalPoint> warm_points(std::size_t count) {
  std::vector<ThermalPoint> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({{static_cast<float>(i), -1.5F, 0.25F}, 36.5F - static_cast<float>(i)});
  return points;
}

ThermalPart warm_part() {
  ThermalPart part;
  part.stamp = Time{Duration{77}};
  part.celsius = true;
  part.epoch = 3;
  part.T_odom_base = SE3::from_xyz_rpy((Vector6() << 1, 2, 3, 0, 0, 1).finished());
  return part;
}

TEST(ThermalPart, PartsMakeTheCloud) {
  const auto points = warm_points(4500);
  ThermalPart part = warm_part();
  std::vector<ThermalPoint> got;
  int parts = 0;
  for (; part.first < points.size(); ++parts) {
    std::vector<std::byte> body;
    const std::uint32_t taken = encode(part, points, body);
    ASSERT_LE(body.size(), Record::kMaxBody);
    const auto decoded = decode_thermal(body);
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    EXPECT_EQ(decoded->stamp, part.stamp);
    EXPECT_TRUE(decoded->celsius);
    EXPECT_EQ(decoded->epoch, 3U);
    EXPECT_LT((decoded->T_odom_base.inverse() * part.T_odom_base).log().norm(), 1e-12);
    EXPECT_EQ(decoded->total, points.size());
    EXPECT_EQ(decoded->first, part.first);
    got.insert(got.end(), decoded->points.begin(), decoded->points.end());
    part.first += taken;
  }
  EXPECT_EQ(parts, 3);
  ASSERT_EQ(got.size(), points.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].point_base, points[i].point_base);
    EXPECT_EQ(got[i].value, points[i].value);
  }
}

TEST(ThermalPart, IsExact) {
  std::vector<std::byte> body;
  encode(warm_part(), warm_points(3), body);
  test::expect_exact(body, decode_thermal);
  body.clear();
  EXPECT_EQ(encode(warm_part(), {}, body), 0U);
  EXPECT_TRUE(decode_thermal(body));
}

TEST(ThermalPart, ValuesAreFinite) {
  auto points = warm_points(3);
  points[1].value = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::byte> body;
  encode(warm_part(), points, body);
  EXPECT_FALSE(decode_thermal(body));
}

}  // namespace
}  // namespace cairn::clients
