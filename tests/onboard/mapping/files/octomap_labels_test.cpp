// SPDX-License-Identifier: Apache-2.0
// The oracle is OctoMap's own ColorOcTree.
#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>

#include <sstream>
#include <string>

#include "onboard/mapping/files/octomap_file.hpp"
#include "onboard/mapping/tree/label_evidence.hpp"
#include "onboard/mapping/tree/voxel_label.hpp"

namespace cairn::mapping {
namespace {

std::vector<std::byte> ot_bytes(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string label_text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string written(const octomap::AbstractOcTree& tree) {
  std::stringstream out;
  tree.write(out);
  return out.str();
}

/// Four voxels side by side: two with a label, one without, one free.
template <class Tree, class Paint>
std::unique_ptr<Tree> four_voxels(Paint paint) {
  auto tree = std::make_unique<Tree>(0.1);
  for (unsigned i = 0; i < 4; ++i) {
    const octomap::OcTreeKey key(static_cast<octomap::key_type>(32768 + i), 32768, 32768);
    paint(*tree->setNodeValue(key, i == 3 ? -1.0F : 1.0F), i);
  }
  return tree;
}

std::unique_ptr<SemanticOcTree> four_labels() {
  return four_voxels<SemanticOcTree>([](SemanticNode& node, unsigned i) {
    if (i < 2) node.set_label_id(VoxelLabel::of(i == 0 ? 13 : 2, i).code);
  });
}

std::string four_colours() {
  const auto tree = four_voxels<octomap::ColorOcTree>([](octomap::ColorOcTreeNode& node, unsigned i) {
    if (i == 0) node.setColor(0, 0, 142);
    if (i == 1) node.setColor(70, 70, 70);
  });
  tree->updateInnerOccupancy();
  return written(*tree);
}

TEST(OctoMapFile, LabelsAreTheColoursThatOctoMapWrites) {
  EXPECT_EQ(label_text_of(encode_ot(*four_labels())), four_colours());
}

TEST(OctoMapFile, OctoMapReadsAMapWithLabelsAsAColorOcTreeOfTheClassesColours) {
  const auto tree = four_voxels<SemanticOcTree>([](SemanticNode& node, unsigned i) {
    LabelEvidence evidence;  // as a run leaves it
    evidence.add(i == 0 ? 13 : 8, 40);
    if (i < 2) node.set_label_id(evidence.id());
  });
  std::stringstream file(label_text_of(encode_ot(*tree)));
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(file));
  const auto* colours = dynamic_cast<const octomap::ColorOcTree*>(read.get());
  ASSERT_NE(colours, nullptr);
  EXPECT_EQ(colours->size(), tree->size());
  const auto colour = [&](int i) {
    return colours->search(octomap::OcTreeKey(static_cast<octomap::key_type>(32768 + i), 32768, 32768))->getColor();
  };
  EXPECT_EQ(colour(0), octomap::ColorOcTreeNode::Color(0, 0, 142));     // car
  EXPECT_EQ(colour(1), octomap::ColorOcTreeNode::Color(107, 142, 35));  // vegetation
  EXPECT_EQ(colour(2), octomap::ColorOcTreeNode::Color());
}

TEST(OctoMapFile, LabelsComeBackAsTheSurestGrade) {
  const auto tree = decode_ot(ot_bytes(four_colours()));
  ASSERT_TRUE(tree) << to_string(tree.error());
  const auto label = [&](int i) {
    return VoxelLabel::from_id(
        (*tree)->search(octomap::OcTreeKey(static_cast<octomap::key_type>(32768 + i), 32768, 32768))->label_id());
  };
  EXPECT_EQ(label(0), VoxelLabel::of(13, 0));
  EXPECT_EQ(label(1), VoxelLabel::of(2, 0));
  EXPECT_FALSE(label(2).any());
  EXPECT_FALSE(label(3).any());
}

TEST(OctoMapFileRead, OtherColoursAndFreeSpaceHaveNoLabel) {
  const auto colours = four_voxels<octomap::ColorOcTree>([](octomap::ColorOcTreeNode& node, unsigned i) {
    node.setColor(0, 0, i == 3 ? 142 : 143);  // free, and painted as a car is
  });
  const auto tree = decode_ot(ot_bytes(written(*colours)));
  ASSERT_TRUE(tree) << to_string(tree.error());
  for (auto leaf = (*tree)->begin_leafs(); leaf != (*tree)->end_leafs(); ++leaf) EXPECT_EQ(leaf->label_id(), 0U);
  EXPECT_TRUE(label_text_of(encode_ot(**tree)).find("id OcTree") != std::string::npos);
}

}  // namespace
}  // namespace cairn::mapping
