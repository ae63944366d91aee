// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/patch_grid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

namespace cairn::odometry {
namespace {

using Oracle = std::map<std::array<int, 3>, float>;

std::array<int, 3> key(const BlockIndex& b) { return {b.x, b.y, b.z}; }

TEST(PatchGrid, CountsPointsPerBlockAsAMapDoesThroughAddingAndForgetting) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> at(-12, 12);
  PatchGrid grid(0.5F, false, {100000, 400});
  Oracle oracle;
  const auto add = [&](int points) {
    for (int i = 0; i < points; ++i) {
      const BlockIndex b{at(random), at(random), at(random)};
      grid.add(b, grid.centre(b), {0, 0, 1}, {});
      ++oracle[key(b)];
    }
  };
  const Eigen::Vector3d centre(1, 2, 0);
  for (int round = 0; round < 3; ++round) {
    add(4000);
    grid.refit({}, {{0, 0, 3}, {0, 0, 1}});
    grid.keep_within(centre, 4.0);
    std::erase_if(oracle, [&](const auto& e) {
      return (grid.centre({e.first[0], e.first[1], e.first[2]}) - centre).norm() > 4.0;
    });
    ASSERT_EQ(grid.size(), oracle.size());
    for (const auto& [k, count] : oracle) {
      const Moments* m = grid.moments({k[0], k[1], k[2]});
      ASSERT_NE(m, nullptr);
      EXPECT_EQ(m->count, count);
    }
  }
  grid.clear();
  EXPECT_EQ(grid.size(), 0U);
}

TEST(PatchGrid, RefusesBlocksAndPointsBeyondItsLimits) {
  PatchGrid grid(1, false, {10, 5});
  for (int i = 0; i < 100; ++i)
    for (int k = 0; k < 20; ++k) grid.add({i, 0, 0}, {i + 0.5, 0.5, 0.5}, {0, 0, 1}, {});
  EXPECT_EQ(grid.size(), 10U);
  EXPECT_LE(grid.moments({0, 0, 0})->count, 5);
}

}  // namespace
}  // namespace cairn::odometry
