// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/tree_copy.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn::mapping {
namespace {

std::unique_ptr<SemanticOcTree> copy_of(const SemanticOcTree& tree, std::size_t nodes) {
  TreeCopy copy(tree);
  while (!copy.step(tree, nodes)) {
  }
  auto taken = copy.take();
  taken->canonicalise();
  return taken;
}

TEST(TreeCopy, IsTheTreeForAnySliceSize) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const auto tree = random_map<SemanticOcTree>(seed, 3000);
    if (seed == 0) saturate_block(*tree, true);
    for (const std::size_t nodes : {0U, 1U, 100U, 1U << 20U})
      EXPECT_EQ(differing_nodes(*copy_of(*tree, nodes), *tree), 0U);
  }
  EXPECT_EQ(copy_of(SemanticOcTree(0.1), 10)->size(), 0U);
}

TEST(TreeCopy, KeepsResolutionAndSensorModel) {
  SemanticOcTree tree(0.25);
  tree.setProbHit(0.8);
  tree.updateNode(1.0, 1.0, 1.0, true);
  const auto copy = copy_of(tree, 5);
  EXPECT_EQ(copy->getResolution(), 0.25);
  EXPECT_EQ(copy->sensor_model().hit, tree.sensor_model().hit);
}

/// Log-odds of the voxels of one cube, as far as they are known.
using Cube = std::map<std::uint64_t, float>;
using Cubes = std::map<std::uint64_t, Cube>;

Cubes cubes_of(const SemanticOcTree& tree) {
  SemanticOcTree fine(tree);
  fine.expand();
  Cubes cubes;
  for (auto leaf = fine.begin_leafs(); leaf != fine.end_leafs(); ++leaf) {
    const auto key = leaf.getKey();
    const auto id = [&key](unsigned shift) {
      return (std::uint64_t{key[0]} >> shift) << 32 | (std::uint64_t{key[1]} >> shift) << 16 | key[2] >> shift;
    };
    cubes[id(5)][id(0)] = leaf->getLogOdds();
  }
  return cubes;
}

TEST(TreeCopy, EveryCubeIsOfOneMomentWhileTheMapChanges) {
  const auto tree = random_map<SemanticOcTree>(1, 200);
  saturate_block(*tree, false);
  std::vector<Cubes> moments;
  TreeCopy copy(*tree);
  for (unsigned round = 2;; ++round) {
    moments.push_back(cubes_of(*tree));
    if (copy.step(*tree, 60)) break;
    scatter_updates(*tree, round, 50);
    // What was free and one leaf becomes many, and again one.
    saturate_block(*tree, round % 2 == 0);
  }
  const auto taken = copy.take();
  taken->canonicalise();
  EXPECT_TRUE(taken->is_canonical());
  EXPECT_EQ(taken->calcNumNodes(), taken->size());
  ASSERT_GT(moments.size(), 3U);
  const Cubes copied = cubes_of(*taken);
  for (const auto& [id, cube] : copied) {
    bool found = false;
    for (const Cubes& moment : moments) found = found || (moment.contains(id) && moment.at(id) == cube);
    EXPECT_TRUE(found);
  }
  for (const auto& [id, cube] : moments.front()) EXPECT_TRUE(copied.contains(id));
}

/// Eight cubes of free space become one leaf while they are half copied.
TEST(TreeCopy, APrunedLeafFillsWhatIsLeftOfIt) {
  SemanticOcTree tree(0.1);
  const auto fill = [&tree](float log_odds) {
    for (unsigned x = 0; x < 64; ++x)
      for (unsigned y = 0; y < 64; ++y)
        for (unsigned z = 0; z < 64; ++z)
          tree.setNodeValue(
              octomap::OcTreeKey(static_cast<octomap::key_type>(32768 + x), static_cast<octomap::key_type>(32768 + y),
                                 static_cast<octomap::key_type>(32768 + z)),
              log_odds);
  };
  fill(-1);
  tree.updateNode(octomap::OcTreeKey(32768, 32768, 32768), true);
  tree.updateNode(octomap::OcTreeKey(32768 + 63, 32768 + 63, 32768 + 63), true);
  TreeCopy copy(tree);
  EXPECT_FALSE(copy.step(tree, 1));
  fill(-2);
  while (!copy.step(tree, 1)) {
  }
  const auto taken = copy.take();
  taken->canonicalise();
  EXPECT_EQ(taken->search(octomap::OcTreeKey(32768 + 40, 32768 + 40, 32768 + 40))->getLogOdds(), -2);
  EXPECT_EQ(taken->search(octomap::OcTreeKey(32768 + 5, 32768 + 5, 32768 + 5))->getLogOdds(), -1);
  EXPECT_EQ(taken->calcNumNodes(), taken->size());
}

}  // namespace
}  // namespace cairn::mapping
