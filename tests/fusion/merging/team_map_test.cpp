// SPDX-License-Identifier: Apache-2.0
// The oracle is merge() of whole maps.
#include "fusion/merging/team_map.hpp"

#include <gtest/gtest.h>

#include <random>

#include "fusion/merging/merge.hpp"
#include "tests/fusion/peers/tile_states.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn::merging {
namespace {

constexpr double kResolution = 0.2;
using Tiles = std::map<SubmapKey, std::map<mapping::TileKey, mapping::TileState>>;

/// What some robots have seen: tiles near the origin of each.
Tiles random_tiles(unsigned seed, unsigned robots) {
  std::mt19937 random(seed);
  Tiles tiles;
  const auto near = [&] { return static_cast<std::uint16_t>(32768 + 8 * (random() % 5) - 16); };
  for (std::uint64_t robot = 1; robot <= robots; ++robot)
    for (int i = 0; i < 40; ++i)
      tiles[{robot, static_cast<std::uint16_t>(robot == 2 ? random() % 2 : 0)}]
           [mapping::TileKey::of_voxel(near(), near(), near())] = peers::random_tile_state(random);
  return tiles;
}

SE3 map_pose(double x, double y, double z, double yaw) {
  Vector6 v;
  v << x, y, z, 0.01, -0.02, yaw;
  return SE3::from_xyz_rpy(v);
}

SubmapPoses poses_of(const Tiles& tiles, double shift = 0) {
  SubmapPoses poses;
  for (const auto& [submap, _] : tiles)
    poses[submap] =
        submap.robot == 1 ? SE3() : map_pose(0.33 * static_cast<double>(submap.robot) + shift, -0.41, 0.07, 0.7);
  return poses;
}

void finish(TeamMap& map) {
  Budget ample = Budget::steps(1'000'000);
  ASSERT_TRUE(map.fuse(ample));
}

void put_all(TeamMap& map, const Tiles& tiles) {
  for (const auto& [submap, layer] : tiles)
    for (const auto& [tile, state] : layer) map.put(submap, tile, state, Time{});
}

std::unique_ptr<TeamMap> fused(const Tiles& tiles, const SubmapPoses& poses) {
  auto map = std::make_unique<TeamMap>(kResolution, Policy::kRelativeEntropy);
  put_all(*map, tiles);
  map->place(poses);
  finish(*map);
  return map;
}

std::unique_ptr<mapping::SemanticOcTree> merged(const Tiles& tiles, const SubmapPoses& poses) {
  Contributions contributions;
  for (const auto& [submap, layer] : tiles) {
    auto tree = std::make_shared<mapping::SemanticOcTree>(kResolution);
    for (const auto& [tile, state] : layer) mapping::write_tile(*tree, tile, state);
    contributions[10 * submap.robot + submap.submap] = {1, tree, poses.at(submap)};
  }
  return std::move(merge(contributions).value());
}

/// Leaves of one map that the other does not have alike, to within the steps of log-odds.
std::size_t different(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b) {
  std::size_t count = 0;
  mapping::SemanticOcTree fine(a);
  fine.expand();
  for (auto leaf = fine.begin_leafs(); leaf != fine.end_leafs(); ++leaf) {
    const mapping::SemanticNode* other = b.search(leaf.getKey());
    if (other == nullptr || std::abs(other->getLogOdds() - leaf->getLogOdds()) > 1e-3F) ++count;
  }
  return count;
}

TEST(TeamMap, IsWhatMergingWholeMapsGives) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Tiles tiles = random_tiles(seed, 3);
    const auto map = fused(tiles, poses_of(tiles));
    const auto oracle = merged(tiles, poses_of(tiles));
    EXPECT_TRUE(map->map().is_canonical());
    EXPECT_EQ(map->map().size(), map->map().calcNumNodes());
    EXPECT_EQ(different(map->map(), *oracle), 0U);
    EXPECT_EQ(different(*oracle, map->map()), 0U);
  }
}

TEST(TeamMap, ASubmapThatHasJustBegunBelongsToWhatIsShown) {
  Tiles tiles = random_tiles(6, 2);
  auto& begun = tiles[{2, 1}];
  while (begun.size() > 10) begun.erase(begun.begin());
  const auto at_once = fused(tiles, poses_of(tiles));
  TeamMap map(kResolution, Policy::kRelativeEntropy);
  put_all(map, tiles);
  SubmapPoses before = poses_of(tiles);
  before.erase({2, 1});
  map.place(before);
  finish(map);
  const mapping::SemanticOcTree* shown = &map.map();
  map.place(poses_of(tiles));
  finish(map);
  EXPECT_EQ(&map.map(), shown) << "nothing was built anew";
  EXPECT_EQ(different(map.map(), at_once->map()), 0U);
  EXPECT_EQ(different(at_once->map(), map.map()), 0U);
}

TEST(TeamMap, HowTheWorkWasCutAndOrderedDoesNotMatter) {
  const Tiles tiles = random_tiles(4, 3), older = random_tiles(5, 3);
  const auto at_once = fused(tiles, poses_of(tiles));
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::mt19937 random(seed);
    TeamMap map(kResolution, Policy::kRelativeEntropy);
    put_all(map, older);
    std::vector<std::pair<SubmapKey, mapping::TileKey>> order;
    for (const auto& [submap, layer] : tiles)
      for (const auto& [tile, state] : layer) order.emplace_back(submap, tile);
    std::shuffle(order.begin(), order.end(), random);
    for (const auto& [submap, tile] : order) {
      if (random() % 5 == 0) map.place(poses_of(tiles, static_cast<double>(random() % 3)));
      if (random() % 9 == 0) map.set_focus({static_cast<double>(random() % 7), 0, 0});
      map.put(submap, tile, tiles.at(submap).at(tile), Time{});
      Budget few = Budget::steps(static_cast<int>(random() % 40));
      (void)map.fuse(few);
    }
    for (const auto& [submap, layer] : older)
      for (const auto& [tile, state] : layer)
        if (!tiles.contains(submap) || !tiles.at(submap).contains(tile)) map.put(submap, tile, {}, Time{});
    map.place(poses_of(tiles));
    finish(map);
    EXPECT_EQ(mapping::differing_nodes(map.map(), at_once->map()), 0U);
  }
}

TEST(TeamMap, ANewMapIsShownWithWhatChangedMeanwhile) {
  const Tiles tiles = random_tiles(6, 3);
  TeamMap map(kResolution, Policy::kRelativeEntropy);
  put_all(map, random_tiles(7, 3));
  map.place(poses_of(tiles));
  finish(map);
  map.place(poses_of(tiles, 1));
  Budget few = Budget::steps(10);
  ASSERT_FALSE(map.fuse(few));  // the new map is begun
  put_all(map, tiles);
  const SubmapKey moved{3, 0};
  while (map.poses().at(moved).matrix() != poses_of(tiles, 1).at(moved).matrix()) {
    Budget one = Budget::steps(1);
    (void)map.fuse(one);
  }
  EXPECT_TRUE(map.shows_newest_tiles());
}

std::map<std::uint64_t, std::uint32_t> labels_of(const mapping::SemanticOcTree& map) {
  std::map<std::uint64_t, std::uint32_t> labels;
  mapping::SemanticOcTree fine(map);
  fine.expand();
  for (auto leaf = fine.begin_leafs(); leaf != fine.end_leafs(); ++leaf)
    if (leaf->label_id() != 0)
      labels[std::uint64_t{leaf.getKey()[0]} << 32U | std::uint64_t{leaf.getKey()[1]} << 16U | leaf.getKey()[2]] =
          leaf->label_id();
  return labels;
}

Tiles labelled(Tiles tiles, unsigned seed) {
  std::mt19937 random(seed);
  for (auto& [submap, layer] : tiles)
    for (auto& [tile, state] : layer)
      if (random() % 3 != 0) state = peers::with_labels(state, random, 12);
  return tiles;
}

TEST(TeamMap, LabelsAreFusedInWhateverOrderTheyCame) {
  const Tiles plain = random_tiles(7, 3), tiles = labelled(plain, 1);
  const auto map = fused(tiles, poses_of(tiles));
  const auto labels = labels_of(map->map());
  EXPECT_GT(labels.size(), 500U);
  EXPECT_TRUE(map->map().is_canonical());
  TeamMap other(kResolution, Policy::kRelativeEntropy);
  other.place(poses_of(tiles));
  put_all(other, labelled(plain, 2));
  finish(other);
  for (auto layer = tiles.rbegin(); layer != tiles.rend(); ++layer)
    for (auto tile = layer->second.rbegin(); tile != layer->second.rend(); ++tile)
      other.put(layer->first, tile->first, tile->second, Time{});
  finish(other);
  EXPECT_EQ(labels_of(other.map()), labels);
  EXPECT_EQ(mapping::differing_nodes(other.map(), map->map()), 0U);
}

TEST(TeamMap, TwoWhoAgreeAboutALabelAreSurer) {
  mapping::TileState wall;
  wall.set(2, 3, 4, 3.5F);
  std::vector<mapping::VoxelLabel> car(512), tree(512);
  car[2 + 8 * (3 + 8 * 4)] = mapping::VoxelLabel::of(13, 2);
  tree[2 + 8 * (3 + 8 * 4)] = mapping::VoxelLabel::of(8, 1);
  const mapping::TileKey at = mapping::TileKey::of_voxel(32768, 32768, 32768);
  const auto fused_of = [&](const std::vector<std::vector<mapping::VoxelLabel>>& said) {
    Tiles tiles;
    SubmapPoses poses;
    for (std::uint64_t robot = 1; robot <= said.size(); ++robot) {
      wall.set_labels(said[robot - 1]);
      tiles[{robot, 0}][at] = wall;
      poses[{robot, 0}] = SE3();
    }
    return mapping::VoxelLabel::from_id(labels_of(fused(tiles, poses)->map()).begin()->second);
  };
  EXPECT_EQ(fused_of({car}), mapping::VoxelLabel::of(13, 2));
  EXPECT_EQ(fused_of({car, std::vector<mapping::VoxelLabel>(512)}), mapping::VoxelLabel::of(13, 2))
      << "who says nothing changes nothing";
  EXPECT_EQ(fused_of({car, car}).class_id(), 13U);
  EXPECT_LT(fused_of({car, car}).grade(), 2U);
  EXPECT_EQ(fused_of({car, tree}).class_id(), 8U) << "the surer";
}

TEST(TeamMap, WithoutARobotItIsWhatItWasBefore) {
  Tiles tiles = random_tiles(6, 3);
  auto map = fused(tiles, poses_of(tiles));
  Tiles without = tiles;
  std::erase_if(without, [](const auto& layer) { return layer.first.robot == 2; });
  map->place(poses_of(without));
  finish(*map);
  EXPECT_EQ(mapping::differing_nodes(map->map(), fused(without, poses_of(without))->map()), 0U);
  map->place(poses_of(tiles));
  finish(*map);
  EXPECT_EQ(mapping::differing_nodes(map->map(), fused(tiles, poses_of(tiles))->map()), 0U);
  map->drop(2);
  finish(*map);
  EXPECT_EQ(mapping::differing_nodes(map->map(), fused(without, poses_of(without))->map()), 0U);
}

TEST(TeamMap, IsOfOneSetOfPosesAtAnyTime) {
  const Tiles tiles = random_tiles(7, 2);
  auto map = fused(tiles, poses_of(tiles));
  const auto before = fused(tiles, poses_of(tiles)), after = fused(tiles, poses_of(tiles, 2));
  map->place(poses_of(tiles, 2));
  int steps = 0;
  for (bool done = false; !done; ++steps) {
    Budget one = Budget::steps(1);
    done = map->fuse(one);
    EXPECT_EQ(mapping::differing_nodes(map->map(), done ? after->map() : before->map()), 0U);
  }
  EXPECT_GT(steps, 50);
}

TEST(TeamMap, NewPosesComeThroughWhileTilesGoOnChanging) {
  const Tiles tiles = random_tiles(7, 2), others = random_tiles(8, 2);
  auto map = fused(tiles, poses_of(tiles));
  map->place(poses_of(tiles, 2));
  int rounds = 0;
  for (; map->poses().at({2, 0}).matrix() != poses_of(tiles, 2).at({2, 0}).matrix(); ++rounds) {
    ASSERT_LT(rounds, 200);
    put_all(*map, rounds % 2 == 0 ? others : tiles);  // more than can be fused
    Budget few = Budget::steps(30);
    EXPECT_FALSE(map->fuse(few));
  }
  EXPECT_GT(rounds, 5);
}

TEST(TeamMap, SaysWhoHadASay) {
  const Tiles tiles = random_tiles(8, 3);
  const auto map = fused(tiles, poses_of(tiles));
  std::set<std::uint64_t> robots;
  for (const mapping::TileKey tile : mapping::known_tiles(map->map(), 1000)) {
    const auto origin = map->origin_of(tile);
    EXPECT_FALSE(origin.robots.empty());
    EXPECT_TRUE(std::ranges::is_sorted(origin.robots));
    robots.insert(origin.robots.begin(), origin.robots.end());
  }
  EXPECT_EQ(robots, (std::set<std::uint64_t>{1, 2, 3}));
}

TEST(TeamMap, PosesThatCannotBeDoNotTakePart) {
  const Tiles tiles = random_tiles(9, 2);
  SubmapPoses poses = poses_of(tiles);
  for (auto& [submap, T] : poses)
    if (submap.robot == 2) T = map_pose(1e9, 0, 0, 0);
  Tiles first;
  first[{1, 0}] = tiles.at({1, 0});
  EXPECT_EQ(mapping::differing_nodes(fused(tiles, poses)->map(), fused(first, poses_of(first))->map()), 0U);
}

}  // namespace
}  // namespace cairn::merging
