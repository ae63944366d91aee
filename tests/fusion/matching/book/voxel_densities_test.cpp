// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/voxel_densities.hpp"

#include <gtest/gtest.h>

namespace cairn::matching {
namespace {

constexpr double kVoxel_m = 0.2;

/// A level plate of 6 m × 6 m, one voxel in `every` × `every`.
PointGrid plate(int every) {
  std::vector<Eigen::Vector3f> points;
  for (int x = 0; x < 30; x += every)
    for (int y = 0; y < 30; y += every)
      points.emplace_back(static_cast<float>(x * kVoxel_m), static_cast<float>(y * kVoxel_m), 0);
  return {points, 0.8F};
}

TEST(SparseMap, HasTheVoxelsOfTheThinnerMap) {
  const PointGrid thin = plate(2), thick = plate(1);
  const SparseMap b = sparser_of(thick, thin, kVoxel_m), a = sparser_of(thin, thick, kVoxel_m);
  EXPECT_TRUE(b.is_b);
  EXPECT_FALSE(a.is_b);
  EXPECT_EQ(b.voxels.size(), thin.points().size());
  EXPECT_EQ(a.voxels, b.voxels);
  EXPECT_GT(a.dense_mean, 3 * a.densities.front()) << "a corner of a plate that has a quarter of the voxels";
}

TEST(SparseMap, AVoxelHasAsManyPartnersAsTheDensitiesSay) {
  const PointGrid thin = plate(2), thick = plate(1);
  const SparseMap sparse = sparser_of(thick, thin, kVoxel_m);
  ASSERT_FALSE(sparse.alike);
  const int own = sparse.densities[0];
  EXPECT_EQ(sparse.partners(0, own), 1);
  EXPECT_EQ(sparse.partners(0, 3.1 * own), 3);
  EXPECT_EQ(sparse.partners(0, 0), 1);
  EXPECT_EQ(sparse.partners(0, 1000.0 * own), SparseMap::kMostPartners);
}

TEST(SparseMap, MapsOfLikeDensitiesGetOnePartnerEach) {
  const PointGrid one = plate(1), other = plate(1);
  const SparseMap sparse = sparser_of(one, other, kVoxel_m);
  EXPECT_TRUE(sparse.alike);
  EXPECT_EQ(sparse.partners(0, 1000), 1);
}

TEST(SparseMap, OfNothingIsEmpty) {
  const PointGrid nothing({}, 0.8F);
  EXPECT_TRUE(sparser_of(nothing, nothing, kVoxel_m).voxels.empty());
}

}  // namespace
}  // namespace cairn::matching
