// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/labels/label_updater.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "onboard/mapping/files/cairn_file.hpp"
#include "onboard/mapping/mapper.hpp"
#include "onboard/mapping/tree/tile_state.hpp"
#include "onboard/mapping/tree/tree_copy.hpp"

namespace cairn::mapping {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr std::uint8_t kRoad = 0, kCar = 13;

MappingConfig small() {
  MappingConfig config;
  config.resolution_m = 0.2;
  config.reserve_mb = 1;
  config.label_trust = 0.5;
  return config;
}

/// A floor and a wall, seen from 1 m above the floor.
Points scene(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> across(-4, 4), up(0, 2);
  Points points;
  for (int i = 0; i < 4000; ++i) points.emplace_back(across(random), across(random), -1.02F);
  for (int i = 0; i < 2000; ++i) points.emplace_back(4.53F, across(random), up(random) - 1);
  return points;
}

LabelledPoint labelled(const Eigen::Vector3f& p, std::uint8_t class_id, std::uint8_t probability = 230,
                       std::uint8_t weight = 128) {
  return {p, class_id, probability, weight};
}

std::vector<LabelledPoint> labels_of(const Points& points) {
  std::vector<LabelledPoint> all;
  for (const auto& p : points) all.push_back(labelled(p, p.x() > 4.4F ? kCar : kRoad));
  return all;
}

struct LabelledMap {
  Workers workers{1};
  Mapper mapper{small(), workers};
  LabelledMap() {
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(mapper.insert(scene(1), Eigen::Vector3f::Zero()));
  }
  VoxelLabel at(const Eigen::Vector3f& p) const {
    const auto* node = mapper.tree().search(p.x(), p.y(), p.z());
    return node != nullptr ? VoxelLabel::from_id(node->label_id()) : VoxelLabel{};
  }
};

TEST(LabelUpdater, OccupancyStaysToTheBit) {
  LabelledMap with, without;
  with.mapper.label(labels_of(scene(1)));
  auto leaf = without.mapper.tree().begin_leafs(SemanticOcTree::kDepth);
  std::size_t compared = 0;
  for (auto end = without.mapper.tree().end_leafs(); leaf != end; ++leaf, ++compared)
    EXPECT_EQ(with.mapper.tree().search(leaf.getCoordinate())->getLogOdds(), leaf->getLogOdds());
  EXPECT_GT(compared, 1000U);
  EXPECT_TRUE(with.mapper.tree().is_canonical());
}

TEST(LabelUpdater, EachVoxelTakesTheMeanOfItsPointsOnceForEachPicture) {
  LabelledMap map;
  const auto points = labels_of(scene(1));
  const LabelReport report = map.mapper.label(points);
  std::map<std::tuple<int, int, int>, std::vector<LabelledPoint>> voxels;
  for (const auto& p : points) {
    octomap::OcTreeKey key;
    ASSERT_TRUE(map.mapper.tree().coordToKeyChecked(p.point_odom.x(), p.point_odom.y(), p.point_odom.z(), key));
    voxels[{key[0], key[1], key[2]}].push_back(p);
  }
  std::size_t occupied = 0;
  for (const auto& [key, inside] : voxels) {
    const auto [x, y, z] = key;
    const auto* node = map.mapper.tree().search(octomap::OcTreeKey(
        static_cast<octomap::key_type>(x), static_cast<octomap::key_type>(y), static_cast<octomap::key_type>(z)));
    if (node == nullptr || !map.mapper.tree().isNodeOccupied(node)) continue;
    ++occupied;
    LabelEvidence expected;
    for (const std::uint8_t k : {kRoad, kCar}) {
      double steps = 0;
      for (const auto& p : inside)
        steps += p.class_id == k ? gain_256ths(p.probability) / 256.0 * p.weight / 255 / 2 : 0;
      expected.add(k, static_cast<unsigned>(std::floor(steps / static_cast<double>(inside.size()) + 0.5)));
    }
    EXPECT_EQ(LabelEvidence::from_id(node->label_id()), expected);
  }
  EXPECT_EQ(report.voxels, occupied);
  EXPECT_EQ(report.points, points.size());
  EXPECT_GT(occupied, 500U);
}

TEST(LabelUpdater, TheOrderOfPointsDoesNotMatter) {
  LabelledMap a, b;
  auto points = labels_of(scene(1));
  a.mapper.label(points);
  std::shuffle(points.begin(), points.end(), std::mt19937(3));
  b.mapper.label(points);
  EXPECT_EQ(encode_cairn(a.mapper.tree()), encode_cairn(b.mapper.tree()));
}

TEST(LabelUpdater, WhatIsNotOccupiedTakesNone) {
  LabelledMap map;
  const float nan = std::nanf("");
  const std::vector<LabelledPoint> points{labelled({0, 0, 0}, kCar),     // free
                                          labelled({100, 0, 0}, kCar),   // unknown
                                          labelled({1e9F, 0, 0}, kCar),  // outside
                                          labelled({nan, 0, 0}, kCar),   //
                                          labelled(scene(1)[0], kNoClass)};
  const auto before = encode_cairn(map.mapper.tree());
  const LabelReport report = map.mapper.label(points);
  EXPECT_EQ(report.not_occupied, points.size());
  EXPECT_EQ(report.voxels, 0U);
  EXPECT_EQ(encode_cairn(map.mapper.tree()), before);
}

TEST(LabelUpdater, AnEmptyMapTakesNone) {
  Workers workers{1};
  Mapper mapper(small(), workers);
  EXPECT_EQ(mapper.label(labels_of(scene(1))).voxels, 0U);
  EXPECT_EQ(mapper.tree().size(), 0U);
}

TEST(LabelUpdater, WhatBecomesFreeLosesItsLabel) {
  LabelledMap map;
  const Points post{{2.1F, 0.1F, 0.1F}, {2.1F, 0.1F, 0.3F}};
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(map.mapper.insert(post, Eigen::Vector3f::Zero()));
  map.mapper.label(std::vector{labelled(post[0], kCar), labelled(post[1], kCar)});
  ASSERT_TRUE(map.at(post[0]).any());
  const Points behind{{4.53F, 0.21F, 0.21F}, {4.53F, 0.214F, 0.64F}};
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(map.mapper.insert(behind, Eigen::Vector3f::Zero()));
  const auto* node = map.mapper.tree().search(post[0].x(), post[0].y(), post[0].z());
  ASSERT_NE(node, nullptr);
  ASSERT_FALSE(map.mapper.tree().isNodeOccupied(node));
  EXPECT_EQ(node->label_id(), 0U);
}

TEST(LabelUpdater, EqualEvidenceIsPruned) {
  SemanticOcTree tree(0.2);
  for (const float x : {0.1F, 0.3F})
    for (const float y : {0.1F, 0.3F})
      for (const float z : {0.1F, 0.3F}) tree.updateNode(octomap::point3d(x, y, z), true);
  const std::size_t nodes = tree.size();
  std::vector<LabelledPoint> corners;
  for (const float x : {0.1F, 0.3F})
    for (const float y : {0.1F, 0.3F})
      for (const float z : {0.1F, 0.3F}) corners.push_back(labelled({x, y, z}, kCar));
  LabelUpdater updater(1);
  std::vector<TileKey> changed;
  updater.update(std::span(corners).first(4), tree, changed);
  EXPECT_EQ(tree.size(), nodes + 8) << "half of them have a label";
  updater.update(std::span(corners).last(4), tree, changed);
  EXPECT_EQ(tree.size(), nodes);
  EXPECT_EQ(changed.size(), 1U);
  EXPECT_EQ(tree.calcNumNodes(), tree.size());
}

TEST(LabelUpdater, FilesAndCopiesAndTilesKeepIt) {
  LabelledMap map;
  for (int i = 0; i < 3; ++i) map.mapper.label(labels_of(scene(1)));
  const auto bytes = encode_cairn(map.mapper.tree());
  const auto read = decode_cairn(bytes);
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(encode_cairn(**read), bytes);

  TreeCopy copy(map.mapper.tree());
  while (!copy.step(map.mapper.tree(), 1000)) {
  }
  const auto copied = copy.take();
  copied->canonicalise();
  EXPECT_EQ(encode_cairn(*copied), bytes);

  octomap::OcTreeKey key = map.mapper.tree().coordToKey(1.1, 1.1, -1.02);
  const TileState tile = read_tile(map.mapper.tree(), TileKey::of_voxel(key[0], key[1], key[2]));
  EXPECT_EQ(tile.label(key[0] & 7U, key[1] & 7U, key[2] & 7U).class_id(), kRoad);
}

TEST(LabelUpdater, ADamagedIdInAFileIsRefused) {
  SemanticOcTree tree(0.2);
  tree.updateNode(octomap::point3d(1, 1, 1), true)->set_label_id(0xFFFF'FFFFU);
  const auto read = decode_cairn(encode_cairn(tree));
  ASSERT_TRUE(read) << "no writer stores what is no label";
  EXPECT_EQ((*read)->search(octomap::point3d(1, 1, 1))->label_id(), 0U);
}

TEST(LabelUpdater, NamesTheTilesWhoseClassChanges) {
  LabelledMap map;
  (void)map.mapper.take_changed_tiles();
  const auto point = scene(1)[0];
  EXPECT_EQ(map.mapper.label(std::vector{labelled(point, kRoad)}).changed_tiles, 1U);
  EXPECT_EQ(map.mapper.take_changed_tiles().size(), 1U);
  EXPECT_EQ(map.mapper.label(std::vector{labelled(point, kRoad)}).changed_tiles, 0U) << "the same class again";
  for (int i = 0; i < 9; ++i) map.mapper.label(std::vector{labelled(point, kCar)});
  EXPECT_EQ(map.mapper.take_changed_tiles().size(), 1U);
}

TEST(LabelUpdater, GainIsTheLogLikelihoodRatio) {
  for (int i = 1; i < 256; ++i) {
    const double p = std::min(i / 255.0, 0.99);
    const double steps = std::max(0.0, std::log(18 * p / (1 - p)) / LabelEvidence::kNatsPerStep);
    EXPECT_NEAR(gain_256ths(static_cast<std::uint8_t>(i)), steps * 256, 0.51) << i;
  }
  EXPECT_EQ(gain_256ths(0), 0U);
}

}  // namespace
}  // namespace cairn::mapping
