// SPDX-License-Identifier: Apache-2.0
// OctoMap itself is the oracle: what octomap_msgs does with a message gives the map again.
#include "tools/ros/messages/map.hpp"

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <sstream>

#include "onboard/mapping/tree/tile_state.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::ros {
namespace {

using mapping::SemanticOcTree;
using mapping::TileKey;
using mapping::TileState;
using mapping::VoxelLabel;

constexpr double kResolution = 0.2;

void fill(SemanticOcTree& map) {
  TileState wall;
  std::vector<VoxelLabel> labels(512);
  for (unsigned z = 0; z < 8; ++z)
    for (unsigned y = 0; y < 8; ++y) {
      wall.set(3, y, z, 3.5F);
      wall.set(2, y, z, y < 4 ? -1.6F : -0.4F);
      if (z > 3) labels[3 + 8 * (y + 8 * z)] = VoxelLabel::of(z > 5 ? 8 : 2, 1);
    }
  wall.set_labels(labels);
  mapping::write_tile(map, TileKey::of_voxel(32'768, 32'776, 32'768), wall);
  TileState open;
  for (unsigned i = 0; i < 512; ++i) open.set(i & 7U, i >> 3U & 7U, i >> 6U, -1.6F);
  mapping::write_tile(map, TileKey::of_voxel(32'800, 32'700, 32'760), open);
}

std::istringstream data_of(const Octomap& message) {
  return std::istringstream(std::string(reinterpret_cast<const char*>(message.data._buffer), message.data._length));
}

class RosMap : public ::testing::Test {
 protected:
  RosMap() : map_(kResolution) { fill(map_); }
  Octomap message(MapForm form) {
    return octomap_of(map_, form, header_of(Time{}, Duration{}, "odom", arena_), arena_).value();
  }
  SemanticOcTree map_;
  Arena arena_;
};

TEST_F(RosMap, FullHasTheLogOddsOfEachVoxel) {
  const Octomap full = message(MapForm::kFull);
  EXPECT_FALSE(full.binary);
  EXPECT_STREQ(full.id, "OcTree");
  EXPECT_EQ(full.resolution, kResolution);
  EXPECT_STREQ(full.header.frame_id, "odom");
  octomap::OcTree tree(full.resolution);
  auto data = data_of(full);
  tree.readData(data);
  EXPECT_EQ(tree.size(), map_.size());
  for (auto leaf = map_.begin_leafs(); leaf != map_.end_leafs(); ++leaf) {
    const auto* found = tree.search(leaf.getKey(), leaf.getDepth());
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->getLogOdds(), leaf->getLogOdds());
  }
}

TEST_F(RosMap, BinaryHasWhatIsOccupiedAndFree) {
  const Octomap binary = message(MapForm::kBinary);
  EXPECT_TRUE(binary.binary);
  octomap::OcTree tree(binary.resolution);
  auto data = data_of(binary);
  tree.readBinaryData(data);
  EXPECT_LT(binary.data._length, message(MapForm::kFull).data._length / 4);
  for (auto leaf = map_.begin_leafs(); leaf != map_.end_leafs(); ++leaf) {
    const auto* found = tree.search(leaf.getKey());
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(tree.isNodeOccupied(found), map_.isNodeOccupied(*leaf));
  }
}

/// The same map built with OctoMap's own colours is written as the same bytes.
TEST_F(RosMap, ColorIsWhatOctoMapWrites) {
  const Octomap color = message(MapForm::kColor);
  EXPECT_STREQ(color.id, "ColorOcTree");
  EXPECT_FALSE(color.binary);
  octomap::ColorOcTree expected(kResolution);
  for (auto voxel = map_.begin_leafs(); voxel != map_.end_leafs(); ++voxel) {
    const unsigned edge = 1U << (SemanticOcTree::kDepth - voxel.getDepth());
    const octomap::OcTreeKey first = voxel.getIndexKey();
    for (unsigned i = 0; i < edge * edge * edge; ++i) {
      const octomap::OcTreeKey key(static_cast<octomap::key_type>(first[0] + i % edge),
                                   static_cast<octomap::key_type>(first[1] + i / edge % edge),
                                   static_cast<octomap::key_type>(first[2] + i / edge / edge));
      const ClassColour colour = colour_of_label(voxel->label_id());
      expected.setNodeValue(key, voxel->getLogOdds(), true)->setColor(colour.r, colour.g, colour.b);
    }
  }
  expected.updateInnerOccupancy();
  expected.prune();
  std::ostringstream bytes;
  expected.writeData(bytes);
  EXPECT_EQ(data_of(color).str(), bytes.str());
  EXPECT_EQ(colour_of_label(VoxelLabel::of(8, 1).code), (ClassColour{107, 142, 35}));
}

TEST_F(RosMap, AnEmptyOneHasNoData) {
  const SemanticOcTree nothing(kResolution);
  for (const MapForm form : {MapForm::kBinary, MapForm::kFull, MapForm::kColor})
    EXPECT_EQ(octomap_of(nothing, form, Header{}, arena_).value().data._length, 0U);
}

}  // namespace
}  // namespace cairn::ros
