// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/mover_error.hpp"

#include <gtest/gtest.h>

namespace cairn::cli {
namespace {

constexpr std::uint8_t kWallClass = 3;

/// A wall of 20 × 10 voxels at x = 5 m in the world.
std::unique_ptr<mapping::SemanticOcTree> wall_before(const SE3& T_map_world = {}) {
  auto tree = std::make_unique<mapping::SemanticOcTree>(0.1);
  for (int y = 0; y < 20; ++y)
    for (int z = 0; z < 10; ++z) {
      const Eigen::Vector3f p = (T_map_world * Eigen::Vector3d(5.05, 0.1 * y + 0.05, 0.1 * z + 0.05)).cast<float>();
      tree->updateNode(octomap::point3d(p.x(), p.y(), p.z()), true);
    }
  return tree;
}

/// What a LiDAR at the world's origin sees of the wall, and of a person of 4 voxels that stands 2 m before it, high
/// enough that no beam to the wall passes through them.
TrueScan sweep_of_wall(const SE3& T_path_world = {}) {
  TrueScan scan;
  scan.T_path_base = scan.T_path_lidar = T_path_world;
  const auto add = [&](double x, double y, double z, std::uint8_t class_id) {
    const Eigen::Vector3d p(x, y, z);
    scan.returns.push_back({(T_path_world * p).cast<float>(), static_cast<float>(p.norm()), class_id});
  };
  for (int y = 0; y < 20; ++y)
    for (int z = 0; z < 10; ++z) add(5.05, 0.1 * y + 0.05, 0.1 * z + 0.05, kWallClass);
  for (int z = 0; z < 4; ++z) add(3.05, 1.05, 1.55 + 0.1 * z, MoverTruth::kPersonId);
  return scan;
}

class Movers : public ::testing::Test {
 protected:
  /// Three sweeps: as often a voxel must be seen.
  void see(MoverTruth& movers, const SE3& T_world_map = {}) const {
    for (int i = 0; i < 3; ++i) {
      movers.count(sweep_of_wall());
      ASSERT_TRUE(movers.insert(sweep_of_wall(T_world_map.inverse())));
    }
  }
  std::unique_ptr<mapping::SemanticOcTree> world_ = wall_before();
};

TEST_F(Movers, AMapWithoutThePersonIsRightWhereverItsGridLies) {
  for (const double offset : {0.0, 0.04, 0.09}) {
    const SE3 T_world_map = SE3::from_xyz_rpy((Vector6() << offset, -offset, offset, 0, 0, 5 * offset).finished());
    MoverTruth movers(*world_, T_world_map, {});
    see(movers, T_world_map);
    const MoverError e = movers.judge(*wall_before(T_world_map.inverse()));
    EXPECT_EQ(e.seen_static_voxels, 200U);
    EXPECT_GT(e.static_voxels, 190U);
    EXPECT_EQ(e.kept, e.static_voxels);
    EXPECT_EQ(e.mover_voxels, 4U);
    EXPECT_EQ(e.dropped, 4U);
  }
}

TEST_F(Movers, APersonInTheMapAndAHoleInTheWallAreCounted) {
  MoverTruth movers(*world_, {}, {});
  see(movers);
  auto map = wall_before();
  for (int z = 0; z < 3; ++z)
    map->updateNode(octomap::point3d(3.05F, 1.05F, 1.55F + 0.1F * static_cast<float>(z)), true);
  for (int y = 0; y < 10; ++y)  // a hole of 10 × 10 voxels; its rim is within the tolerance
    for (int z = 0; z < 10; ++z)
      map->updateNode(
          octomap::point3d(5.05F, 0.1F * static_cast<float>(y) + 0.05F, 0.1F * static_cast<float>(z) + 0.05F), -10.0F);
  const MoverError e = movers.judge(*map);
  EXPECT_DOUBLE_EQ(*e.dynamic_accuracy(), 0.25);
  EXPECT_EQ(e.static_voxels, 200U);
  EXPECT_EQ(e.kept, 110U);
  EXPECT_DOUBLE_EQ(*e.static_accuracy(), *e.seen_static_accuracy());
}

TEST_F(Movers, APersonAtTheWallAndReturnsBeyondTheRangeDoNotCount) {
  MoverTruth movers(*world_, {}, {.max_range_m = 6});
  TrueScan scan;
  scan.returns.push_back({{4.95F, 1.05F, 0.5F}, 5.0F, MoverTruth::kPersonId});  // beside an occupied voxel
  scan.returns.push_back({{9.0F, 1.05F, 0.5F}, 9.1F, MoverTruth::kPersonId});
  movers.count(scan);
  const MoverError e = movers.judge(*wall_before());
  EXPECT_EQ(e.mover_voxels, 0U);
  EXPECT_FALSE(e.dynamic_accuracy());
  EXPECT_FALSE(e.static_accuracy());
}

}  // namespace
}  // namespace cairn::cli
