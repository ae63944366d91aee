// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/nearest_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace cairn::matching {
namespace {

std::vector<Surfel> random_surfels(int n, float extent) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> at(-extent, extent);
  std::vector<Surfel> surfels(static_cast<std::size_t>(n));
  for (Surfel& s : surfels) s.point = {at(random), at(random), at(random)};
  return surfels;
}

TEST(NearestGrid, IsNearestUpToTheSizeOfACell) {
  const float cell = 0.2F, gate = 0.6F;
  const auto surfels = random_surfels(2000, 4);
  const NearestGrid grid(surfels, cell, 1.2F);
  const float slack = cell * std::sqrt(3.0F);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> at(-5, 5);
  int found = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3f q(at(random), at(random), at(random));
    float nearest = std::numeric_limits<float>::infinity();
    for (const Surfel& s : surfels) nearest = std::min(nearest, (s.point - q).norm());
    const int k = grid.nearest(q, gate);
    if (k == NearestGrid::kNone) {
      EXPECT_GT(nearest + slack, gate);
      continue;
    }
    ++found;
    const float distance = (surfels[static_cast<std::size_t>(k)].point - q).norm();
    EXPECT_LT(distance, gate);
    EXPECT_LE(distance, nearest + slack);
  }
  EXPECT_GT(found, 1000);
}

TEST(NearestGrid, IsExactAtTheCentresOfCells) {
  const float cell = 0.2F, reach = 0.8F;
  const auto surfels = random_surfels(300, 2);
  const NearestGrid grid(surfels, cell, reach);
  int found = 0;
  for (int x = -15; x < 15; ++x)
    for (int y = -15; y < 15; ++y)
      for (int z = -15; z < 15; ++z) {
        const Eigen::Vector3f centre = cell * (Eigen::Vector3f(float(x), float(y), float(z)).array() + 0.5F);
        float nearest = reach;
        for (const Surfel& s : surfels) nearest = std::min(nearest, (s.point - centre).norm());
        const int k = grid.nearest(centre, reach);
        ASSERT_EQ(k != NearestGrid::kNone, nearest < reach) << x << " " << y << " " << z;
        if (k == NearestGrid::kNone) continue;
        ++found;
        EXPECT_NEAR((surfels[static_cast<std::size_t>(k)].point - centre).norm(), nearest, 1e-5F);
      }
  EXPECT_GT(found, 1000);
}

// The first answers are looked for, the later ones are those of filled bricks.
TEST(NearestGrid, AnswersDoNotDependOnTheOrderOfQuestions) {
  const auto surfels = random_surfels(2000, 4);
  const NearestGrid forwards(surfels, 0.2F, 0.8F), backwards(surfels, 0.2F, 0.8F);
  std::mt19937 random(6);
  std::uniform_real_distribution<float> at(-5, 5);
  std::vector<Eigen::Vector3f> questions(60'000);  // 80 for each brick
  for (Eigen::Vector3f& q : questions) q = {at(random), at(random), at(random)};
  std::vector<int> answers, others;
  for (const Eigen::Vector3f& q : questions) answers.push_back(forwards.nearest(q, 0.7F));
  std::ranges::reverse(questions);
  for (const Eigen::Vector3f& q : questions) others.push_back(backwards.nearest(q, 0.7F));
  std::ranges::reverse(others);
  EXPECT_EQ(answers, others);
  EXPECT_GT(std::ranges::count_if(answers, [](int i) { return i != NearestGrid::kNone; }), 20'000);
}

TEST(NearestGrid, OfEquallyNearSurfelsTheFirstIsHeld) {
  std::vector<Surfel> surfels(3);
  surfels[0].point = {0.1F, 0.1F, 0.5F};
  surfels[1].point = {0.1F, 0.1F, -0.3F};
  surfels[2].point = {0.1F, 0.1F, 0.5F};
  const NearestGrid grid(surfels, 0.2F, 0.8F);
  for (int i = 0; i < 2 * NearestGrid::kFewQuestions; ++i) EXPECT_EQ(grid.nearest({0.1F, 0.1F, 0.1F}, 0.7F), 0) << i;
}

TEST(NearestGrid, AnyFloatIsSafeAndAnEmptyMapHasNoNeighbours) {
  const auto surfels = random_surfels(10, 1);
  const NearestGrid grid(surfels, 0.2F, 0.6F), empty({}, 0.2F, 0.6F);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30F})
    EXPECT_EQ(grid.nearest({0, bad, 0}, 0.5F), NearestGrid::kNone);
  EXPECT_EQ(empty.nearest({0, 0, 0}, 0.5F), NearestGrid::kNone);
}

}  // namespace
}  // namespace cairn::matching
