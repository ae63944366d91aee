// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/thermal/thermal_map.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cairn::cli {
namespace {

SE3 moved(double x) { return SE3::from_xyz_rpy((Vector6() << x, 0, 0, 0, 0, 0).finished()); }

TEST(ThermalMap, HasTheMeanOfEachVoxel) {
  ThermalMap map(0.5);
  ASSERT_TRUE(map.add({}, std::vector<ThermalPoint>{{{0.1F, 0.1F, 0.1F}, 20}, {{-0.1F, 0, 0}, 5}}));
  ASSERT_TRUE(map.add(moved(0.2), std::vector<ThermalPoint>{{{0.1F, 0.3F, 0.1F}, 30}}));
  const auto means = map.means();
  ASSERT_EQ(means.size(), 2U);
  EXPECT_EQ(means[0].value, 5);
  EXPECT_EQ(means[0].points, 1);
  EXPECT_EQ(means[1].value, 25);
  EXPECT_EQ(means[1].points, 2);
  EXPECT_LT((means[1].point - Eigen::Vector3f(0.2F, 0.2F, 0.1F)).norm(), 1e-6F);
}

TEST(ThermalMap, TheOrderIsThatOfPlacesNotOfArrival) {
  std::vector<ThermalPoint> points;
  for (int i = 0; i < 200; ++i) points.push_back({{static_cast<float>(i * 37 % 200), 0, 0}, 1});
  ThermalMap map(1);
  ASSERT_TRUE(map.add({}, points));
  const auto means = map.means();
  ASSERT_EQ(means.size(), 200U);
  for (std::size_t i = 0; i < means.size(); ++i) ASSERT_EQ(means[i].point.x(), static_cast<float>(i));
}

TEST(ThermalMap, PointsOfNoPlaceAreLeftOut) {
  ThermalMap map(0.1);
  const float none = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(map.add({}, std::vector<ThermalPoint>{{{none, 0, 0}, 1}, {{1e10F, 0, 0}, 1}}));
  EXPECT_EQ(map.size(), 0U);
}

}  // namespace
}  // namespace cairn::cli
