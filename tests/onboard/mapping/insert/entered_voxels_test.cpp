// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/entered_voxels.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hal/semantic_class.hpp"
#include "onboard/mapping/mapper.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn::mapping {
namespace {

using Cloud = std::vector<Eigen::Vector3f>;

constexpr HeightBand kBand{-1, 1};

/// A wall 5 m ahead, from `low` to `high` tenths of a metre.
Cloud far_wall(int low = -8, int high = 8) {
  Cloud points;
  for (int y = -20; y <= 20; ++y)
    for (int z = low; z <= high; ++z)
      points.emplace_back(5.05F, 0.05F + 0.1F * static_cast<float>(y), 0.05F + 0.1F * static_cast<float>(z));
  return points;
}

/// Somebody 3 m ahead, on rays to the wall.
Cloud passer() {
  Cloud points;
  for (const Eigen::Vector3f& p : far_wall())
    if (std::abs(p.y()) < 0.3F) points.emplace_back(p * 0.6F);
  return points;
}

/// Of the wall, what somebody does not hide.
Cloud wall_with(const Cloud& body) {
  Cloud points = body;
  for (const Eigen::Vector3f& p : far_wall())
    if (std::abs(p.y()) >= 0.3F) points.push_back(p);
  return points;
}

struct Seen {
  explicit Seen(bool clear = true, unsigned threads = 1) : workers(threads), mapper(config(clear), workers) {}
  static MappingConfig config(bool clear) {
    MappingConfig c;
    c.clear_movers = clear;
    return c;
  }
  void insert(const Cloud& points, int times, const HeightBand& band = kBand) {
    for (int i = 0; i < times; ++i) {
      const auto inserted = mapper.insert(points, Eigen::Vector3f::Zero(), band);
      ASSERT_TRUE(inserted);
      cleared += inserted->cleared;
    }
  }
  [[nodiscard]] int occupied(const Cloud& points) const {
    int count = 0;
    for (const auto& p : points) {
      const SemanticNode* node = mapper.tree().search(p.x(), p.y(), p.z());
      count += node != nullptr && mapper.tree().isNodeOccupied(node) ? 1 : 0;
    }
    return count;
  }
  Workers workers;
  Mapper mapper;
  std::size_t cleared = 0;
};

TEST(EnteredVoxels, WhoCameAndWentIsGoneAfterThreeScans) {
  Seen clearing, plain(false);
  for (Seen* map : {&clearing, &plain}) {
    map->insert(far_wall(), 5);
    map->insert(wall_with(passer()), 6);
    EXPECT_EQ(map->occupied(passer()), static_cast<int>(passer().size()));
    map->insert(far_wall(), 3);
  }
  EXPECT_EQ(clearing.occupied(passer()), 0);
  EXPECT_GT(clearing.cleared, 20U);
  EXPECT_GT(plain.occupied(passer()), 20);
  EXPECT_EQ(plain.cleared, 0U);
  EXPECT_EQ(clearing.occupied(far_wall()), plain.occupied(far_wall()));
  EXPECT_TRUE(clearing.mapper.tree().is_canonical());
}

TEST(EnteredVoxels, WhatNoRayMeetsGoesWithItsBody) {
  Seen clearing, plain(false);
  for (Seen* map : {&clearing, &plain}) {
    map->insert(far_wall(), 5);
    map->insert(wall_with(passer()), 6);
    map->insert(far_wall(-8, 0), 10);  // the upper half is not seen any more
  }
  EXPECT_EQ(clearing.occupied(passer()), 0);
  EXPECT_GT(plain.occupied(passer()), 20);
}

TEST(EnteredVoxels, WhoStandsStaysInTheMap) {
  Seen map;
  map.insert(far_wall(), 5);
  map.insert(wall_with(passer()), 100);
  EXPECT_EQ(map.occupied(passer()), static_cast<int>(passer().size()));
  EXPECT_EQ(map.cleared, 0U);
}

TEST(EnteredVoxels, WhatStoodFromTheStartClearsAsInOctoMap) {
  Seen clearing, plain(false);
  for (Seen* map : {&clearing, &plain}) {
    map->insert(wall_with(passer()), 6);
    map->insert(far_wall(), 5);
  }
  EXPECT_EQ(clearing.cleared, 0U);
  EXPECT_EQ(differing_nodes(clearing.mapper.tree(), plain.mapper.tree()), 0U);
}

TEST(EnteredVoxels, NoiseOfAWallIsNobody) {
  Seen clearing, plain(false);
  for (Seen* map : {&clearing, &plain}) {
    std::mt19937 random(1);
    std::normal_distribution<float> noise(0, 0.02F);
    for (int i = 0; i < 50; ++i) {
      Cloud points = far_wall();
      for (auto& p : points) p += p.normalized() * noise(random);
      map->insert(points, 1);
    }
  }
  EXPECT_EQ(differing_nodes(clearing.mapper.tree(), plain.mapper.tree()), 0U);
}

TEST(EnteredVoxels, OutsideOfTheBandNothingChanges) {
  Seen clearing, plain(false);
  for (Seen* map : {&clearing, &plain}) {
    map->insert(far_wall(), 5, {2, 3});
    map->insert(wall_with(passer()), 6, {2, 3});
    map->insert(far_wall(), 2, {2, 3});
  }
  EXPECT_EQ(differing_nodes(clearing.mapper.tree(), plain.mapper.tree()), 0U);
}

TEST(EnteredVoxels, TheClassSaysHowReadily) {
  EXPECT_EQ(rays_to_clear(kNoClass), 3);
  EXPECT_EQ(rays_to_clear(kPersonClass), 1);
  EXPECT_EQ(rays_to_clear(13), 1);  // car
  EXPECT_EQ(rays_to_clear(2), 0);   // building
  for (const auto& [class_id, scans, left] : {std::tuple{11, 1, false}, {2, 3, true}}) {
    Seen map;
    map.insert(far_wall(), 5);
    map.insert(wall_with(passer()), 6);
    std::vector<LabelledPoint> labels;
    for (const auto& p : passer()) labels.push_back({p, static_cast<std::uint8_t>(class_id), 250, 255});
    map.mapper.label(labels);
    map.insert(far_wall(), scans);
    EXPECT_EQ(map.occupied(passer()) > 0, left) << class_id;
  }
}

TEST(EnteredVoxels, ChangedTilesTellOfIt) {
  Seen map;
  map.insert(far_wall(), 5);
  map.insert(wall_with(passer()), 6);
  map.insert(far_wall(), 2);
  (void)map.mapper.take_changed_tiles();
  map.insert(far_wall(), 1);
  ASSERT_GT(map.cleared, 0U);
  const auto changed = map.mapper.changed_tiles();
  EXPECT_FALSE(changed.empty());
  EXPECT_TRUE(std::ranges::is_sorted(changed));
}

TEST(EnteredVoxels, ThreadsDoNotMatter) {
  Seen one(true, 1), three(true, 3);
  for (Seen* map : {&one, &three}) {
    map->insert(far_wall(), 5);
    map->insert(wall_with(passer()), 6);
    map->insert(far_wall(-8, 0), 6);
  }
  EXPECT_EQ(one.cleared, three.cleared);
  EXPECT_EQ(differing_nodes(one.mapper.tree(), three.mapper.tree()), 0U);
}

TEST(EnteredVoxels, ANewMapKnowsNothingOfTheOldOne) {
  Seen map;
  map.insert(far_wall(), 5);
  map.insert(wall_with(passer()), 6);
  (void)map.mapper.begin_anew();
  map.insert(far_wall(), 10);
  EXPECT_EQ(map.cleared, 0U);
}

}  // namespace
}  // namespace cairn::mapping
