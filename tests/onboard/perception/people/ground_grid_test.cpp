// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/ground_grid.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/onboard/perception/people/walkers.hpp"

namespace cairn::people {
namespace {

using test::scan_of;

/// The yard of walkers.hpp on a hillside: it rises by `slope` m for each metre to the east.
std::vector<Eigen::Vector3f> hillside(const std::vector<test::Cylinder>& bodies, float slope) {
  auto points = scan_of(bodies);
  for (Eigen::Vector3f& p : points) p.z() += slope * p.x();
  return points;
}

/// The farthest that the ground is off, within 8 m of the robot.
float worst_of(GroundGrid& ground, float slope) {
  float worst = 0;
  for (float x = -8; x <= 8; x += 0.5F)
    for (float y = -8; y <= 8; y += 0.5F) worst = std::max(worst, std::abs(ground.height(x, y) - slope * x));
  return worst;
}

class GroundGridOf : public ::testing::TestWithParam<float> {};

TEST_P(GroundGridOf, FollowsASlopeAmongPeople) {
  const float slope = GetParam();
  GroundGrid ground(20);
  ground.fill(hillside({{{3, 1}}, {{4, -2}}, {{-3, 0.5}}, {{0, 5}}, {{6, 3}}}, slope), test::sensor(),
              static_cast<float>(test::kSensorHeight));
  EXPECT_LT(worst_of(ground, slope), 0.15F);
}

INSTANTIATE_TEST_SUITE_P(Slopes, GroundGridOf, ::testing::Values(0.0F, 0.1F, -0.15F, 0.25F));

TEST(GroundGrid, IsAsUnderTheRobotWhereNothingWasSeen) {
  GroundGrid ground(20);
  ground.fill({}, {1, 2, 3}, 0.6F);
  EXPECT_FLOAT_EQ(ground.height(1, 2), 2.4F);
  EXPECT_FLOAT_EQ(ground.height(100, 2), 2.4F);
}

TEST(GroundGrid, ATableIsNoGround) {
  std::vector<Eigen::Vector3f> points;
  for (float x = -5; x < 5; x += 0.25F)
    for (float y = -5; y < 5; y += 0.25F) points.emplace_back(x, y, x > 1 && x < 3 && std::abs(y) < 1 ? 0.7F : 0.0F);
  GroundGrid ground(20);
  ground.fill(points, test::sensor(), static_cast<float>(test::kSensorHeight));
  EXPECT_NEAR(ground.height(2, 0), 0, 0.1F);
}

}  // namespace
}  // namespace cairn::people
