// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/book/structural_edges.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace cairn::matching {
namespace {

/// Two walls of 4 × 2 m and 0.1 m voxels that meet along the z axis at an angle; 180° is one flat wall.
std::vector<Voxel> two_walls(double degrees) {
  mapping::SemanticOcTree map(0.1);
  const double turn = degrees * M_PI / 180;
  for (double s = 0; s < 4; s += 0.04)
    for (double z = -1; z < 1; z += 0.05) {
      const auto at = [&](double x, double y) { return octomap::point3d(float(x + 0.05), float(y + 0.05), float(z)); };
      map.setNodeValue(at(s, 0), 2.0F);
      map.setNodeValue(at(s * std::cos(turn), s * std::sin(turn)), 2.0F);
    }
  map.canonicalise();
  return *occupied_voxels(map);
}

TEST(StructuralEdges, AreWhereTwoWallsMeet) {
  EdgeOptions options;
  options.min_angle_cost = 0.25;  // one voxel from the corner, half of the neighbours lie on its own wall
  const auto edges = structural_edges(two_walls(90), 0.1, options);
  ASSERT_GT(edges.voxels.size(), 10U);
  ASSERT_EQ(edges.directions.size(), edges.voxels.size());
  for (std::size_t i = 0; i < edges.voxels.size(); ++i) {
    EXPECT_LT(edges.voxels[i].centre.head<2>().norm(), 0.5F);
    const bool inner = std::abs(edges.voxels[i].centre.z()) < 0.5F;
    EXPECT_TRUE(!inner || std::abs(edges.directions[i].z()) > 0.9F);
  }
  EXPECT_GT(edges.quality, 0.5);  // 1/3 is a ball
  EXPECT_LE(edges.quality, 1.0);
}

TEST(StructuralEdges, FlatAndBluntSurfacesHaveNone) {
  EdgeOptions options;
  options.min_angle_cost = 0.25;
  EXPECT_TRUE(structural_edges(two_walls(180), 0.1, options).voxels.empty());
  EXPECT_TRUE(structural_edges(two_walls(150), 0.1, options).voxels.empty());
  EXPECT_TRUE(structural_edges({}, 0.1).voxels.empty());
}

TEST(StructuralEdges, AreBoundedInAMapThatIsNothingButCorners) {
  std::vector<Voxel> lattice;  // bars along z, 0.3 m apart
  for (int i = 0; i < 40 * 40 * 10; ++i) {
    const Eigen::Vector3i key(3 * (i % 40) + i / 1600 % 2, 3 * (i / 40 % 40), i / 1600);
    lattice.push_back({(key.cast<float>().array() + 0.5F) * 0.1F, key, 0.9F, 0});
  }
  EdgeOptions options;
  options.min_angle_cost = -1;
  EXPECT_LE(structural_edges(lattice, 0.1, options).voxels.size(), kMostCandidates);
}

TEST(StructuralEdges, CovariancesAreBelowBothTheirParts) {
  EdgeOptions options;
  options.min_angle_cost = 0.25;
  const auto edges = structural_edges(two_walls(90), 0.1, options);
  for (std::size_t i = 0; i < edges.voxels.size(); ++i) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> own(edges.covariances[i]);
    EXPECT_GT(own.eigenvalues()[0], 0);
    EXPECT_LT(edges.covariances[i].trace(), voxel_covariance(edges.voxels[i], 0.1).trace());
  }
}

TEST(VoxelNormals, ArePerpendicularToAWall) {
  const auto voxels = two_walls(180);
  const auto normals = voxel_normals(voxels, 3.5);
  ASSERT_EQ(normals.size(), voxels.size());
  for (const auto& n : normals) EXPECT_GT(std::abs(n.y()), 0.95F);
  EXPECT_TRUE(voxel_normals(std::vector<Voxel>{voxels.front()}, 3.5).front().isZero());
}

}  // namespace
}  // namespace cairn::matching
