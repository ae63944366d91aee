// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/tiles/robot_tiles.hpp"

#include <gtest/gtest.h>

#include <random>

namespace cairn::team {
namespace {

constexpr double kTileM = 1.6;

mapping::TileKey tile(int x, int y, int z) {
  const auto voxel = [](int t) { return static_cast<std::uint16_t>(32768 + 8 * t); };
  return mapping::TileKey::of_voxel(voxel(x), voxel(y), voxel(z));
}

/// The slow way: who was where, said by said.
TEST(RobotTiles, ATileIsInTheSubmapItWasSaidInLast) {
  std::mt19937 random(1);
  RobotTiles tiles;
  std::map<mapping::TileKey, std::pair<std::uint16_t, bool>> last;
  for (int step = 0; step < 2000; ++step) {
    const mapping::TileKey key = tile(static_cast<int>(random() % 20) - 10, 0, 0);
    const auto submap = static_cast<std::uint16_t>(random() % 3);
    const bool occupied = random() % 2 == 0;
    const auto held = last.find(key);
    const auto before = tiles.put(key, submap, occupied);
    const bool elsewhere = held != last.end() && held->second.first != submap;
    EXPECT_EQ(before, elsewhere ? std::optional(held->second.first) : std::nullopt);
    last[key] = {submap, occupied};
    std::map<std::uint16_t, RobotTiles::Tiles> walls;
    std::size_t count = 0;
    for (const auto& [k, said] : last)
      if (said.second) count += walls[said.first].insert(k).second ? 1 : 0;
    ASSERT_EQ(tiles.walls_by_submap(), walls);
    ASSERT_EQ(tiles.walls(), count);
  }
}

TEST(RobotTiles, CommonTilesAreThoseOnBothSidesOfTheOrigin) {
  RobotTiles::Tiles a, b;
  for (int i = -20; i < 20; ++i) {
    a.insert(tile(i, -i, i / 4));
    b.insert(tile(i + 3, -i - 2, i / 4 + 1));
  }
  const SE3 there(Eigen::Quaterniond::Identity(), kTileM * Eigen::Vector3d(3.3, -2.2, 1.1));
  EXPECT_EQ(common_tiles(a, b, there, kTileM), a.size());
  EXPECT_EQ(common_tiles(b, a, there.inverse(), kTileM), a.size());
  EXPECT_EQ(common_tiles(a, b, SE3(Eigen::Quaterniond::Identity(), {1e6, 0, 0}), kTileM), 0U);
}

}  // namespace
}  // namespace cairn::team
