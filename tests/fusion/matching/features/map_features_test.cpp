// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/map_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hal/workers.hpp"
#include "onboard/mapping/mapper.hpp"
#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

void expect_equal(std::span<const Surfel> a, std::span<const Surfel> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].point, b[i].point);
    ASSERT_EQ(a[i].normal, b[i].normal);
    ASSERT_EQ(a[i].variation, b[i].variation);
    ASSERT_EQ(a[i].occupancy, b[i].occupancy);
    ASSERT_EQ(a[i].evidence, b[i].evidence);
    ASSERT_EQ(a[i].half_thickness, b[i].half_thickness);
  }
}

TEST(MapFeatures, KeptAsTheMapGrowsAreThoseOfTheWholeMap) {
  const support::Scene scene = support::corridor();
  support::Vlp16 lidar({}, 0.02, 1);
  Workers workers(1);
  mapping::Mapper mapper({}, workers);
  auto kept = MapFeatures::build(mapper.tree());
  ASSERT_TRUE(kept);
  EXPECT_TRUE(kept->fine().empty());
  for (int i = 0; i < 6; ++i) {
    const SE3 at = SE3(Eigen::Quaterniond::Identity(), {3.0 + 2 * i, 2.5, 0.6});
    std::vector<Eigen::Vector3f> points;
    for (const auto& p : lidar
                             .scan(
                                 scene.world, [&](double) { return at; }, 0)
                             .cloud.xyz)
      points.emplace_back((at * p.cast<double>()).cast<float>());
    ASSERT_TRUE(mapper.insert(points, at.translation().cast<float>()));
    // Tiles may come in any order and more than once.
    auto changed = mapper.take_changed_tiles();
    const std::vector<mapping::TileKey> half(changed.begin(), changed.begin() + static_cast<long>(changed.size() / 2));
    std::reverse(changed.begin(), changed.end());
    kept->update(changed);
    kept->update(half);
  }
  // Log-odds that merely move are not told, so let them be told once.
  std::vector<mapping::TileKey> all;
  const auto voxels = occupied_voxels(mapper.tree());
  ASSERT_TRUE(voxels);
  for (const Voxel& v : *voxels)
    if (all.empty() || all.back() != tile_of(v)) all.push_back(tile_of(v));
  const auto afresh = MapFeatures::build(mapper.tree());
  ASSERT_TRUE(afresh);
  ASSERT_EQ(kept->fine().size(), afresh->fine().size());
  kept->update(all);
  expect_equal(kept->fine(), afresh->fine());
  expect_equal(kept->coarse(), afresh->coarse());
}

TEST(MapFeatures, AWallShowsItsThicknessWhereBothFacesWereSeen) {
  const Eigen::Vector3f normal = Eigen::Vector3f(0.8F, 0.6F, 0);
  for (const float thickness : {0.0F, 0.12F, 0.2F}) {
    mapping::SemanticOcTree map(0.1);
    for (float u = -3; u < 3; u += 0.02F)
      for (float z = -1; z < 1; z += 0.02F)
        for (const float face : {-0.5F, 0.5F}) {
          const Eigen::Vector3f p = face * thickness * normal + u * Eigen::Vector3f(-normal.y(), normal.x(), 0);
          map.setNodeValue(octomap::point3d(p.x(), p.y(), z), 2.0F, true);
        }
    map.canonicalise();
    const auto features = MapFeatures::build(map);
    ASSERT_TRUE(features);
    double sum = 0;
    for (const Surfel& s : features->fine()) sum += static_cast<double>(s.half_thickness);
    EXPECT_NEAR(sum / static_cast<double>(features->fine().size()), static_cast<double>(thickness) / 2, 0.025);
  }
}

TEST(MapFeatures, ATiltedPlaneIsAPlaneNotAStaircase) {
  mapping::SemanticOcTree map(0.1);
  const Eigen::Vector3f normal = Eigen::Vector3f(0.3F, -0.2F, 1).normalized();
  for (float x = -3; x < 3; x += 0.02F)
    for (float y = -3; y < 3; y += 0.02F) {
      const float z = -(normal.x() * x + normal.y() * y) / normal.z();
      map.setNodeValue(octomap::point3d(x, y, z), 2.0F, true);
    }
  map.canonicalise();
  const auto features = MapFeatures::build(map);
  ASSERT_TRUE(features);
  EXPECT_FLOAT_EQ(features->fine_m(), 0.2F);
  EXPECT_FLOAT_EQ(features->coarse_m(), 0.4F);
  int inside = 0;
  for (const Surfel& s : features->fine()) {
    if (s.point.head<2>().cwiseAbs().maxCoeff() > 2.5F) continue;
    ++inside;
    EXPECT_GT(std::abs(s.normal.dot(normal)), 0.99F);
    EXPECT_LT(std::abs(s.point.dot(normal)), 0.03F);
    EXPECT_LT(s.variation, 0.05F);
    EXPECT_FALSE(s.structure());
  }
  EXPECT_GT(inside, 500);
}

TEST(MapFeatures, CellsFitTilesAtAnyResolution) {
  for (const double resolution : {0.01, 0.05, 0.08, 0.1, 0.2, 0.5}) {
    mapping::SemanticOcTree map(resolution);
    map.setNodeValue(octomap::OcTreeKey(32767, 32768, 30000), 1.0F);
    const auto features = MapFeatures::build(map);
    ASSERT_TRUE(features);
    ASSERT_EQ(features->fine().size(), 1U);
    EXPECT_FALSE(features->fine()[0].structure());  // alone, it has no normal to agree in
    const double voxels = static_cast<double>(features->fine_m()) / resolution;
    EXPECT_NEAR(std::fmod(8 / voxels + 1e-6, 1.0), 0, 1e-3) << resolution;
    EXPECT_LE(static_cast<double>(features->fine_m()), std::max(0.2, resolution) * 1.001);
  }
}

/// A level floor of two layers, half of the voxels in each.
mapping::SemanticOcTree thick_floor(float upper, float lower) {
  mapping::SemanticOcTree map(0.2);
  for (float x = -3; x < 3; x += 0.2F)
    for (float y = -3; y < 3; y += 0.2F) {
      map.setNodeValue(octomap::point3d(x + 0.1F, y + 0.1F, 0.1F), upper, true);
      map.setNodeValue(octomap::point3d(x + 0.1F, y + 0.1F, -0.1F), lower, true);
    }
  map.canonicalise();
  return map;
}

TEST(MapFeatures, AFloorOfTwoLayersOfVoxelsTellsNoPlacesApart) {
  const auto map = thick_floor(3, 3);
  const auto features = MapFeatures::build(map);
  ASSERT_TRUE(features);
  EXPECT_TRUE(std::ranges::any_of(features->fine(), [](const Surfel& s) { return s.variation > 0.1F; }));
  for (const Surfel& s : features->fine()) {
    const bool inside = s.point.head<2>().cwiseAbs().maxCoeff() < 2.5F;
    EXPECT_FALSE(inside && s.structure());
  }
}

TEST(MapFeatures, WhatWasSeenOftenCountsMoreThanWhatWasSeenOnce) {
  const auto map = thick_floor(3.5F, 0.4F);
  const auto features = MapFeatures::build(map);
  ASSERT_TRUE(features);
  for (const Surfel& s : features->fine()) {
    if (s.point.head<2>().cwiseAbs().maxCoeff() > 2.5F) continue;
    EXPECT_LT(s.variation, 0.1F);
    EXPECT_NEAR(s.point.z(), 0.1F - 0.2F * 0.4F / 3.9F, 0.01F);  // the mean by evidence
    EXPECT_NEAR(s.evidence, s.evidence > 1 ? 3.5F : 0.4F, 0.01F);
  }
}

TEST(MapFeatures, AWallThatWasSeenOnceIsNoStructure) {
  for (const bool often : {false, true}) {
    mapping::SemanticOcTree map(0.2);
    for (float x = -2; x < 2; x += 0.2F)
      for (float z = 0; z < 2; z += 0.2F)
        map.setNodeValue(octomap::point3d(x + 0.1F, 0.1F, z + 0.1F), often ? 3 : 0.4F, true);
    map.canonicalise();
    const auto features = MapFeatures::build(map);
    ASSERT_TRUE(features);
    EXPECT_EQ(std::ranges::any_of(features->fine(), &Surfel::structure), often);
  }
}

TEST(MapEntropy, IsTheBooksFormula) {
  const Voxel anywhere{Eigen::Vector3f::Zero(), Eigen::Vector3i::Zero(), 0.5F, 0};
  std::vector<Voxel> voxels(3, anywhere);
  voxels[1].occupancy = 1.0F;
  voxels[2].occupancy = 0.75F;
  const double at75 = -0.75 * std::log2(0.75);
  EXPECT_NEAR(book_map_entropy(voxels), (0.5 + 0 + at75) / 3, 1e-12);
  EXPECT_EQ(book_map_entropy({}), 0);
}

}  // namespace
}  // namespace cairn::matching
