// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/tiles/published_tiles.hpp"

#include <gtest/gtest.h>

#include "tests/fusion/team/comparisons/known_team.hpp"

namespace cairn::team {
namespace {

constexpr std::size_t kAllTiles = 1U << 20U;

class PublishedTilesTest : public testing::Test {
 protected:
  PublishedTilesTest() {
    team_.publish_walls(2, 0, 0, 5);
    team_.publish_walls(2, 1, 5, 3);
    team_.deploy(2, SE3(), 0.1, 0.01);  // not a tile
  }
  [[nodiscard]] PublishedTiles tiles(std::optional<std::uint16_t> submap = {}) const {
    return PublishedTiles::of(team_.exchange.layers().at(2).holding, 0.2, submap);
  }
  KnownTeam team_;
};

TEST_F(PublishedTilesTest, AreThoseOfAllSubmapsOrOfOne) {
  EXPECT_EQ(tiles().tiles.size(), 8U);
  EXPECT_EQ(tiles(0).tiles.size(), 5U);
  EXPECT_EQ(tiles(1).tiles.size(), 3U);
  EXPECT_EQ(mapping::known_tiles(tiles().map(), kAllTiles).size(), 8U);
}

TEST_F(PublishedTilesTest, AMapInOdomHasTheSameTilesAsTheRobot) {
  const mapping::SemanticOcTree map = tiles(1).map();
  for (const mapping::TileKey tile : mapping::known_tiles(map, kAllTiles)) {
    const auto& item = team_.exchange.layers().at(2).holding.items().at(peers::ItemId::tile(1, tile));
    EXPECT_EQ(mapping::read_tile(map, tile), peers::decode_tile(item.payload).value());
  }
}

TEST_F(PublishedTilesTest, AMovedSubmapLiesWhereItWasMovedTo) {
  PublishedTiles moved = tiles(1);
  moved.T_map_odom[1] = KnownTeam::at(1.6 * 100, 0);
  EXPECT_EQ(moved.T_map_odom_of(0).matrix(), Eigen::Matrix4d::Identity());
  const auto where = mapping::known_tiles(moved.map(), kAllTiles);
  ASSERT_FALSE(where.empty());
  for (const mapping::TileKey tile : where) EXPECT_GE(tile.first_voxel(0), 32768 + 8 * 104);
}

}  // namespace
}  // namespace cairn::team
