// SPDX-License-Identifier: Apache-2.0
// The oracle is octomap::OcTree: the same calls must give the same tree.
#include "onboard/mapping/tree/semantic_octree.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn::mapping {
namespace {

class SemanticOcTreeOracle : public testing::TestWithParam<unsigned> {
 protected:
  static constexpr int kUpdates = 3000;
  std::unique_ptr<SemanticOcTree> ours = random_map<SemanticOcTree>(GetParam(), kUpdates);
  std::unique_ptr<octomap::OcTree> stock = random_map<octomap::OcTree>(GetParam(), kUpdates);
};

TEST_P(SemanticOcTreeOracle, UpdatesGiveTheSameTree) {
  EXPECT_GT(ours->size(), 1000U);
  EXPECT_EQ(differing_nodes(*ours, *stock), 0U);
  EXPECT_EQ(data_of(*ours), data_of(*stock));
  EXPECT_TRUE(ours->is_canonical());
}

TEST_P(SemanticOcTreeOracle, LazyUpdatesGiveTheSameTree) {
  for (unsigned i = 0; i < 64; ++i) {
    const octomap::OcTreeKey at(static_cast<octomap::key_type>(40000 + i % 4), static_cast<octomap::key_type>(i / 4),
                                7);
    ours->updateNode(at, true, true);
    stock->updateNode(at, true, true);
  }
  EXPECT_EQ(differing_nodes(*ours, *stock), 0U);
  EXPECT_FALSE(ours->is_canonical());
  ours->updateInnerOccupancy();
  stock->updateInnerOccupancy();
  EXPECT_EQ(differing_nodes(*ours, *stock), 0U);
}

TEST_P(SemanticOcTreeOracle, PruningAndExpandingGiveTheSameTree) {
  ours->toMaxLikelihood();
  stock->toMaxLikelihood();
  ours->prune();
  stock->prune();
  EXPECT_EQ(differing_nodes(*ours, *stock), 0U);
  const octomap::OcTreeKey inside(32769, 32770, 32771);
  EXPECT_EQ(ours->deleteNode(inside), stock->deleteNode(inside));
  EXPECT_EQ(differing_nodes(*ours, *stock), 0U);
}

TEST_P(SemanticOcTreeOracle, BeginsAnewInTheMemoryThatItHas) {
  scatter_updates(*ours, GetParam() + 100, kUpdates);
  const auto before = ours->memoryUsage();
  ours->begin_anew();
  EXPECT_EQ(ours->size(), 0U);
  EXPECT_EQ(ours->search(octomap::OcTreeKey(32768, 32768, 32768)), nullptr);
  for (int again = 0; again < 3; ++again) {
    ours->begin_anew();
    scatter_updates(*ours, GetParam(), kUpdates);
  }
  octomap::OcTree fresh(ours->getResolution());
  scatter_updates(fresh, GetParam(), kUpdates);
  EXPECT_EQ(differing_nodes(*ours, fresh), 0U);
  EXPECT_EQ(ours->memoryUsage(), before);
}

TEST_P(SemanticOcTreeOracle, StreamsOfOctoMapAreReadByBoth) {
  std::stringstream full, binary;
  stock->writeData(full);
  stock->writeBinaryData(binary);
  SemanticOcTree from_full(0.1), from_binary(0.1);
  octomap::OcTree stock_from_binary(0.1);
  from_full.readData(full);
  EXPECT_EQ(differing_nodes(from_full, *stock), 0U);
  std::stringstream again(binary.str());
  from_binary.readBinaryData(binary);
  stock_from_binary.readBinaryData(again);
  EXPECT_EQ(differing_nodes(from_binary, stock_from_binary), 0U);
}

TEST_P(SemanticOcTreeOracle, QueriesGiveTheSameAnswers) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<float> coordinate(-1.0F, 2.0F);
  for (int i = 0; i < 300; ++i) {
    const octomap::point3d at(coordinate(random), coordinate(random), coordinate(random));
    const octomap::point3d direction(coordinate(random), coordinate(random), coordinate(random));
    const auto* a = ours->search(at);
    const auto* b = stock->search(at);
    ASSERT_EQ(a == nullptr, b == nullptr);
    if (a != nullptr) {
      EXPECT_EQ(a->getLogOdds(), b->getLogOdds());
    }
    octomap::point3d end_a, end_b;
    EXPECT_EQ(ours->castRay(at, direction, end_a, true, 5.0), stock->castRay(at, direction, end_b, true, 5.0));
    EXPECT_EQ(end_a, end_b);
  }
}

TEST_P(SemanticOcTreeOracle, ACopyIsEqualAndIndependent) {
  SemanticOcTree copy(*ours);
  EXPECT_EQ(differing_nodes(copy, *stock), 0U);
  EXPECT_EQ(copy.sensor_model(), ours->sensor_model());
  copy.updateNode(octomap::OcTreeKey(1, 2, 3), true);
  EXPECT_EQ(differing_nodes(*ours, *stock), 0U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SemanticOcTreeOracle, testing::Values(1U, 2U, 3U, 4U));

TEST(SemanticOcTree, DefaultsAreOctoMapsToTheBit) {
  const octomap::OcTree stock(0.1);
  const SensorModel model = SemanticOcTree(0.1).sensor_model();
  const SensorModel expected{stock.getProbHitLog(), stock.getProbMissLog(), stock.getClampingThresMinLog(),
                             stock.getClampingThresMaxLog(), stock.getOccupancyThresLog()};
  EXPECT_EQ(model, expected);
}

TEST(SemanticOcTree, ClearGivesEveryBlockBack) {
  auto tree = random_map<SemanticOcTree>(1, 3000);
  EXPECT_GT(tree->used_bytes(), 0U);
  const std::size_t taken = tree->memoryUsage();
  tree->clear();
  EXPECT_EQ(tree->used_bytes(), 0U);
  EXPECT_EQ(tree->size(), 0U);
  scatter_updates(*tree, 1, 3000);
  EXPECT_EQ(tree->memoryUsage(), taken) << "blocks given back are used again";
}

TEST(SemanticOcTree, ReservedMemoryIsEnoughForAsManyNodes) {
  SemanticOcTree tree(0.1);
  tree.reserve_bytes(std::size_t{8} << 20U);
  const std::size_t reserved = tree.memoryUsage();
  EXPECT_GE(reserved, std::size_t{8} << 20U);
  scatter_updates(tree, 5, 20000);
  EXPECT_LT(tree.used_bytes(), std::size_t{8} << 20U);
  EXPECT_EQ(tree.memoryUsage(), reserved);
}

TEST(SemanticOcTree, DifferentLabelsAreNotPrunedAway) {
  SemanticOcTree tree(0.1);
  saturate_block(tree, true);
  const octomap::OcTreeKey in(32769, 32769, 32769);
  ASSERT_EQ(tree.search(in), tree.search(octomap::OcTreeKey(32770, 32770, 32770))) << "one pruned leaf";
  tree.search(in)->set_label_id(7);
  tree.expandNode(tree.search(in));
  EXPECT_EQ(tree.search(in)->label_id(), 7U) << "children inherit the label";
  tree.search(in)->set_label_id(9);
  tree.canonicalise();
  EXPECT_EQ(tree.search(in)->label_id(), 9U);
  const SemanticOcTree copy(tree);
  EXPECT_EQ(copy.search(in)->label_id(), 9U);
  EXPECT_TRUE(copy == tree);
  tree.search(in)->set_label_id(7);
  tree.canonicalise();
  EXPECT_EQ(tree.search(in), tree.search(octomap::OcTreeKey(32770, 32770, 32770)));
  EXPECT_FALSE(copy == tree);
}

TEST(SemanticOcTree, CanonicaliseHealsALazyTree) {
  SemanticOcTree eager(0.1), lazy(0.1);
  for (unsigned i = 0; i < 512; ++i) {
    const octomap::OcTreeKey at(static_cast<octomap::key_type>(i % 8), static_cast<octomap::key_type>(i / 8 % 8),
                                static_cast<octomap::key_type>(i / 64));
    eager.updateNode(at, true);
    lazy.updateNode(at, true, true);
  }
  EXPECT_NE(differing_nodes(eager, lazy), 0U);
  lazy.canonicalise();
  EXPECT_EQ(differing_nodes(eager, lazy), 0U);
}

TEST(SemanticOcTree, DeletingTheLastChildLeavesALeaf) {
  SemanticOcTree tree(0.1);
  tree.updateNode(octomap::OcTreeKey(5, 5, 5), true);
  tree.deleteNode(octomap::OcTreeKey(5, 5, 5));
  EXPECT_EQ(tree.size(), tree.calcNumNodes());
  EXPECT_EQ(tree.used_bytes(), 0U);
}

}  // namespace
}  // namespace cairn::mapping
