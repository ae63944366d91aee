// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/map_tile.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTreeKey.h>

#include <random>

namespace cairn::mapping {
namespace {

TEST(TileKey, NamesTheTileOfEachVoxel) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto x = static_cast<std::uint16_t>(random()), y = static_cast<std::uint16_t>(random()),
               z = static_cast<std::uint16_t>(random());
    const TileKey tile = TileKey::of_voxel(x, y, z);
    EXPECT_EQ(tile.first_voxel(0), x & ~7);
    EXPECT_EQ(tile.first_voxel(1), y & ~7);
    EXPECT_EQ(tile.first_voxel(2), z & ~7);
    // The digits are OctoMap's child indices, from the root down to depth 13.
    for (unsigned depth = 0; depth < 13; ++depth)
      EXPECT_EQ(tile.morton >> (3 * (12 - depth)) & 7,
                octomap::computeChildIdx({x, y, z}, static_cast<int>(15 - depth)));
  }
}

}  // namespace
}  // namespace cairn::mapping
