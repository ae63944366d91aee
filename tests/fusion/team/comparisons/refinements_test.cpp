// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/refinements.hpp"

#include <gtest/gtest.h>

#include <set>

namespace cairn::team {
namespace {

constexpr double kTileEdgeM = 1.6;

/// Tiles of a corridor: `submap` covers so many from `first` on.
void add(RobotTiles& robot, std::uint16_t submap, int first, int count) {
  const auto voxel = [](int tile) { return static_cast<std::uint16_t>(32768 + 8 * tile); };
  for (int x = first; x < first + count; ++x)
    for (int y = -1; y <= 1; ++y) robot.put(mapping::TileKey::of_voxel(voxel(x), voxel(y), voxel(0)), submap, true);
}

TeamPoses all_at_the_origin(std::uint16_t submaps) {
  TeamPoses poses;
  for (peers::RobotId robot = 1; robot <= 2; ++robot)
    for (std::uint16_t k = 0; k < submaps; ++k) poses.submaps[{robot, k}] = SE3();
  return poses;
}

TEST(Refinements, EachSubmapIsComparedWithTheOneItSharesMostWith) {
  RobotTiles own, other;
  for (std::uint16_t k = 0; k < 4; ++k) {
    add(own, k, 20 * k - 40, 20);
    add(other, k, 20 * k - 33, 20);
  }
  Refinements refinements;
  std::set<SubmapPair> pairs;
  std::set<std::uint16_t> edges;
  while (const auto pair = refinements.next(1, 2, own, other, all_at_the_origin(4), kTileEdgeM)) {
    ASSERT_TRUE(pairs.insert(*pair).second) << "twice";
    EXPECT_TRUE(edges.insert(refinements.edge(*pair)->index()).second);
    EXPECT_EQ(origin_of(refinements.edge(*pair)->index()), EdgeOrigin::kRefined);
  }
  EXPECT_EQ(pairs, (std::set<SubmapPair>{{2, 0, 0}, {2, 1, 1}, {2, 2, 2}, {2, 3, 3}}));
  refinements.forget(2);
  EXPECT_TRUE(refinements.next(1, 2, own, other, all_at_the_origin(4), kTileEdgeM)) << "a peer that begins anew";
}

TEST(Refinements, AnEdgeOfAPairThatIsVoidIsNone) {
  RobotTiles own, other;
  add(own, 0, 0, 20);
  add(own, 1, 20, 20);
  add(other, 0, 0, 20);
  Refinements refinements;
  const auto pair = refinements.next(1, 2, own, other, all_at_the_origin(2), kTileEdgeM);
  ASSERT_TRUE(pair);
  EXPECT_NE(refinements.edge(*pair), nullptr);
  refinements.clear();
  EXPECT_EQ(refinements.edge(*pair), nullptr);
}

TEST(Refinements, AgainWhenThereIsHalfAsMuchMore) {
  RobotTiles own, other;
  add(own, 1, 0, 60);
  add(other, 0, 0, 10);
  add(other, 1, 200, 10);
  Refinements refinements;
  const auto next = [&] { return refinements.next(1, 2, own, other, all_at_the_origin(2), kTileEdgeM).has_value(); };
  add(own, 0, -100, 10);
  EXPECT_TRUE(next());
  add(other, 0, 10, 4);
  EXPECT_FALSE(next());
  add(other, 0, 14, 2);
  EXPECT_TRUE(next());
  EXPECT_FALSE(next());
}

TEST(Refinements, WholeMapsAndTooLittleInCommonAreNotCompared) {
  RobotTiles own, other;
  add(own, 0, 0, 40);
  add(other, 0, 0, 40);
  Refinements refinements;
  EXPECT_FALSE(refinements.next(1, 2, own, other, all_at_the_origin(2), kTileEdgeM)) << "one submap each";
  RobotTiles far;
  add(far, 0, 34, 8);
  add(far, 1, 60, 40);
  EXPECT_FALSE(refinements.next(1, 2, own, far, all_at_the_origin(2), kTileEdgeM));
}

}  // namespace
}  // namespace cairn::team
