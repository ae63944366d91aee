// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/files/point_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <string>
#include <tuple>

#include "onboard/mapping/tree/voxel_label.hpp"
#include "tests/onboard/mapping/random_maps.hpp"
#include "tests/support/hostile_maps.hpp"

namespace cairn::mapping {
namespace {

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(OccupiedVoxelCentres, AreWhatSearchFinds) {
  const auto tree = random_map<SemanticOcTree>(1, 2000);  // with a pruned occupied leaf
  const auto points = occupied_voxel_centres(*tree);
  ASSERT_TRUE(points);
  std::set<std::tuple<int, int, int>> keys;
  for (const Eigen::Vector3f& p : *points) {
    const auto key = tree->coordToKey(octomap::point3d(p.x(), p.y(), p.z()));
    EXPECT_TRUE(keys.insert({key[0], key[1], key[2]}).second) << "twice";
    EXPECT_TRUE(tree->isNodeOccupied(tree->search(key)));
    EXPECT_EQ(tree->keyToCoord(key), octomap::point3d(p.x(), p.y(), p.z())) << "not a centre";
  }
  SemanticOcTree expanded(*tree);
  const auto pruned = tree->search(octomap::OcTreeKey(32768, 32768, 32768));
  ASSERT_NE(pruned, nullptr);
  std::size_t expected = 0;
  for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf)
    if (tree->isNodeOccupied(*leaf)) expected += std::size_t{1} << (3 * (16 - leaf.getDepth()));
  EXPECT_EQ(points->size(), expected);
  EXPECT_GT(expected, 512U);
}

TEST(OccupiedVoxelCentres, AreBounded) {
  EXPECT_EQ(occupied_voxel_centres(*random_map<SemanticOcTree>(1, 10), 100).error().code, Errc::kLimit);
  EXPECT_TRUE(occupied_voxel_centres(SemanticOcTree(0.1))->empty());
}

TEST(OccupiedVoxelCentres, OfAFewNodesThatSpanTheTreeAreRefusedBeforeTheyAreListed) {
  for (const auto& [name, map] : support::hostile_maps()) {
    const auto points = occupied_voxel_centres(*map);
    if (points) {
      EXPECT_LE(points->size(), kSpareVoxels + kVoxelsPerNode * map->size()) << name;
      EXPECT_EQ(points->size(), count_occupied_voxels(*map)) << name;
    } else {
      EXPECT_EQ(points.error().code, Errc::kLimit) << name;
    }
  }
  EXPECT_EQ(count_occupied_voxels(*support::whole_tree(2.0F)), std::uint64_t{1} << 48);
}

TEST(PointFiles, CarryTheFloatsAfterAHeaderThatCountsThem) {
  const std::vector<Eigen::Vector3f> points{{1, 2, 3}, {-4, 5.5F, 6}};
  const std::string floats(reinterpret_cast<const char*>(points.data()), 24);
  const std::string ply = text_of(encode_ply(points));
  EXPECT_TRUE(ply.starts_with("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_NE(ply.find("\nelement vertex 2\n"), ply.npos);
  EXPECT_TRUE(ply.ends_with("end_header\n" + floats));
  const std::string pcd = text_of(encode_pcd(points));
  EXPECT_NE(pcd.find("\nWIDTH 2\n"), pcd.npos);
  EXPECT_NE(pcd.find("\nPOINTS 2\n"), pcd.npos);
  EXPECT_TRUE(pcd.ends_with("DATA binary\n" + floats));
}

TEST(PointFiles, ThePlyOfALabelledMapHasColours) {
  SemanticOcTree map(0.1);
  map.updateNode(octomap::point3d(0.05F, 0.05F, 0.05F), true)->set_label_id(VoxelLabel::of(13, 2).code);
  map.updateNode(octomap::point3d(0.15F, 0.05F, 0.05F), true);
  const auto points = labelled_voxel_centres(map);
  ASSERT_TRUE(points);
  const std::string ply = text_of(encode_ply(*points));
  EXPECT_NE(ply.find("property uchar blue\nproperty uchar label\nend_header\n"), ply.npos);
  const std::string body = ply.substr(ply.size() - 32);
  EXPECT_EQ(body.substr(12, 4), std::string("\x00\x00\x8e\x0d", 4));
  EXPECT_EQ(body.substr(28, 4), "\xcd\xcd\xcd\xff");
}

TEST(PointFiles, WithoutLabelsThereAreNoLabelledCentres) {
  EXPECT_TRUE(labelled_voxel_centres(*random_map<SemanticOcTree>(2, 100))->empty());
  EXPECT_EQ(labelled_voxel_centres(*support::whole_tree(2.0F)).error().code, Errc::kLimit);
}

}  // namespace
}  // namespace cairn::mapping
