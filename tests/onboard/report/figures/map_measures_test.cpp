// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/map_measures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/onboard/report/random_map.hpp"

namespace cairn::report {
namespace {

constexpr double kResolution = 0.1;
constexpr int kHalf = 8;

/// Asks both trees about every voxel: slow, and right by construction.
MapComparison compare_by_search(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b) {
  MapComparison c;
  for_each_voxel(kResolution, kHalf, [&](const octomap::point3d& p) {
    const mapping::SemanticNode *in_a = a.search(p), *in_b = b.search(p);
    const bool occupied_a = in_a != nullptr && a.isNodeOccupied(in_a);
    const bool occupied_b = in_b != nullptr && b.isNodeOccupied(in_b);
    if (in_a != nullptr) ++(occupied_a ? c.occupied_a : c.free_a);
    if (in_b != nullptr) ++(occupied_b ? c.occupied_b : c.free_b);
    if (occupied_a && occupied_b) ++c.occupied_both;
    if (in_a != nullptr && in_b != nullptr) {
      ++(occupied_a == occupied_b ? c.same : c.disagreeing);
      if (in_a->getLogOdds() != in_b->getLogOdds()) ++c.differing_log_odds;
    }
    if (in_a != nullptr && in_b == nullptr) ++c.only_a;
    if (in_a == nullptr && in_b != nullptr) ++c.only_b;
  });
  return c;
}

void expect_equal(const MapComparison& x, const MapComparison& y) {
  EXPECT_EQ(x.same, y.same);
  EXPECT_EQ(x.disagreeing, y.disagreeing);
  EXPECT_EQ(x.only_a, y.only_a);
  EXPECT_EQ(x.only_b, y.only_b);
  EXPECT_EQ(x.occupied_a, y.occupied_a);
  EXPECT_EQ(x.occupied_b, y.occupied_b);
  EXPECT_EQ(x.occupied_both, y.occupied_both);
  EXPECT_EQ(x.free_a, y.free_a);
  EXPECT_EQ(x.free_b, y.free_b);
  EXPECT_EQ(x.differing_log_odds, y.differing_log_odds);
}

TEST(Compare, AgreesWithASearchOfEveryVoxel) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const auto a = random_map(seed), b = random_map(seed + 100);
    const auto c = compare(*a, *b);
    ASSERT_TRUE(c.has_value());
    EXPECT_GT(c->disagreeing, 0U);
    EXPECT_GT(c->same, 0U);
    expect_equal(*c, compare_by_search(*a, *b));
  }
}

TEST(Compare, SwapsSidesWithItsArguments) {
  const auto a = random_map(1), b = random_map(2);
  const auto ab = compare(*a, *b), ba = compare(*b, *a);
  EXPECT_EQ(ab->only_a, ba->only_b);
  EXPECT_EQ(ab->free_a, ba->free_b);
  EXPECT_EQ(ab->same, ba->same);
  EXPECT_EQ(ab->iou_occupied(), ba->iou_occupied());
}

TEST(Compare, OfAMapWithItselfFindsNoDifference) {
  const auto a = random_map(3);
  const auto c = compare(*a, *a);
  EXPECT_EQ(c->disagreeing + c->only_a + c->only_b + c->differing_log_odds, 0U);
  EXPECT_EQ(c->iou_occupied(), 1.0);
  EXPECT_EQ(c->same, c->occupied_a + c->free_a);
}

TEST(Compare, OfEmptyMaps) {
  const mapping::SemanticOcTree empty(kResolution);
  const auto full = random_map(4);
  EXPECT_FALSE(compare(empty, empty)->iou_occupied().has_value());
  const auto c = compare(empty, *full);
  EXPECT_EQ(c->only_b, summarise(*full).occupied + summarise(*full).free);
  EXPECT_EQ(c->iou_occupied(), 0.0);
}

// A map that knows all of space is one node; expanding it would take 2⁴⁸ voxels.
TEST(Compare, CountsHugePrunedCubesWithoutExpandingThem) {
  mapping::SemanticOcTree everything(kResolution);
  bool made = false;
  everything.root_or_new(made)->setLogOdds(-2.0F);
  const auto small = random_map(5);
  const auto c = compare(everything, *small);
  EXPECT_EQ(c->free_a, std::uint64_t{1} << 48);
  EXPECT_EQ(c->same, c->free_b);
  EXPECT_EQ(c->disagreeing, c->occupied_b);
  EXPECT_EQ(c->only_a, (std::uint64_t{1} << 48) - c->free_b - c->occupied_b);
}

TEST(Compare, RefusesAnotherResolution) {
  const mapping::SemanticOcTree a(0.1), b(0.2);
  const auto c = compare(a, b);
  ASSERT_FALSE(c.has_value());
  EXPECT_THAT(to_string(c.error()), testing::HasSubstr("resolution"));
}

TEST(Summarise, AgreesWithASearchOfEveryVoxel) {
  const auto map = random_map(6);
  const MapSummary s = summarise(*map);
  std::uint64_t occupied = 0, free = 0;
  double bits = 0, book = 0, all = 0;
  for_each_voxel(kResolution, kHalf, [&](const octomap::point3d& p) {
    const mapping::SemanticNode* node = map->search(p);
    if (node == nullptr) return;
    const bool is_occupied = map->isNodeOccupied(node);
    ++(is_occupied ? occupied : free);
    all += binary_entropy(node->getOccupancy());
    if (!is_occupied) return;
    bits += binary_entropy(node->getOccupancy());
    book += book_entropy(node->getOccupancy());
  });
  EXPECT_EQ(s.occupied, occupied);
  EXPECT_EQ(s.free, free);
  EXPECT_EQ(s.labelled, 0U);
  EXPECT_NEAR(s.mean_entropy_occupancy.value(), bits / static_cast<double>(occupied), 1e-9);
  EXPECT_NEAR(s.mean_entropy_book.value(), book / static_cast<double>(occupied), 1e-9);
  EXPECT_NEAR(s.mean_entropy_known.value(), all / static_cast<double>(occupied + free), 1e-9);
  EXPECT_EQ(s.nodes, map->size());
  EXPECT_EQ(s.leaves, map->getNumLeafNodes());
  EXPECT_NEAR(s.known_volume_m3(), 1e-3 * static_cast<double>(occupied + free), 1e-9);
}

TEST(Summarise, BoxesWhatIsKnown) {
  mapping::SemanticOcTree map(0.5);
  map.updateNode(octomap::point3d(1.1F, -2.2F, 3.3F), true);
  map.updateNode(octomap::point3d(4.1F, 0.2F, 3.3F), false);
  const MapSummary s = summarise(map);
  EXPECT_NEAR((s.min_m - Eigen::Vector3d(1, -2.5, 3)).norm(), 0, 1e-9);
  EXPECT_NEAR((s.max_m - Eigen::Vector3d(4.5, 0.5, 3.5)).norm(), 0, 1e-9);
  EXPECT_FALSE(summarise(mapping::SemanticOcTree(0.5)).mean_entropy_occupancy.has_value());
}

TEST(Summarise, CountsLabels) {
  mapping::SemanticOcTree map(0.5);
  map.updateNode(octomap::point3d(1, 1, 1), true)->set_label_id(7);
  map.updateNode(octomap::point3d(3, 1, 1), true);
  map.updateNode(octomap::point3d(5, 1, 1), false)->set_label_id(7);  // free space has no class
  const MapSummary s = summarise(map);
  EXPECT_EQ(s.labelled, 1U);
  EXPECT_EQ(s.by_class[1], 1U);
  EXPECT_DOUBLE_EQ(s.mean_entropy_label.value(), label_entropy(7));
  EXPECT_FALSE(summarise(mapping::SemanticOcTree(0.5)).mean_entropy_label.has_value());
}

TEST(Compare, CountsTheClassesOfVoxelsThatBothLabel) {
  mapping::SemanticOcTree a(0.5), b(0.5);
  const auto label = [](mapping::SemanticOcTree& map, float x, unsigned class_id) {
    map.updateNode(octomap::point3d(x, 1, 1), true)->set_label_id(mapping::VoxelLabel::of(class_id, 0).code);
  };
  label(a, 1, 2), label(b, 1, 2);
  label(a, 3, 2), label(b, 3, 8);
  label(a, 5, 2), b.updateNode(octomap::point3d(5, 1, 1), true);
  const auto c = compare(a, b);
  ASSERT_TRUE(c.has_value());
  EXPECT_EQ(c->labels.total(), 2U);
  EXPECT_DOUBLE_EQ(c->labels.agreement().value(), 0.5);
  EXPECT_DOUBLE_EQ(c->labels.miou(0).value(), (0.5 + 0.0) / 2);
}

TEST(Entropy, IsOneBitAtOneHalfAndNoneWhenCertain) {
  EXPECT_DOUBLE_EQ(binary_entropy(0.5), 1);
  EXPECT_DOUBLE_EQ(book_entropy(0.5), 0.5);
  EXPECT_EQ(binary_entropy(0), 0);
  EXPECT_EQ(binary_entropy(1), 0);
  EXPECT_NEAR(binary_entropy(0.971), 0.1894, 2e-4);  // OctoMap's upper clamping value
}

}  // namespace
}  // namespace cairn::report
