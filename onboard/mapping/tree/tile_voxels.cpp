// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/tile_voxels.hpp"

#include <algorithm>

namespace cairn::mapping {
namespace {

bool nothing_known(const float* voxels, int count) {
  return std::all_of(voxels, voxels + count, [](float v) { return v == SemanticNode::kAbsent; });
}

/// Of voxels of which at least one is known.
// NOLINTNEXTLINE(misc-no-recursion)
void write_voxels(const float* voxels, const VoxelLabel* labels, int count, NodeWriter& writer, SemanticNode* node) {
  writer.add_block(node);
  const int each = count / static_cast<int>(SemanticNode::kChildren);
  std::ptrdiff_t made = 0;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    const float* of_child = voxels + static_cast<int>(i) * each;
    if (nothing_known(of_child, each)) continue;
    ++made;
    const VoxelLabel* labels_of_child = labels != nullptr ? labels + static_cast<int>(i) * each : nullptr;
    SemanticNode* child = node->block() + i;
    if (each > 1) {
      write_voxels(of_child, labels_of_child, each, writer, child);
      continue;
    }
    child->setLogOdds(*of_child);
    if (labels != nullptr) child->set_label_id(labels_of_child->code);
  }
  writer.count(made);
  writer.refresh(node);
}

// NOLINTNEXTLINE(misc-no-recursion)
bool read_labels(const SemanticNode& node, VoxelLabel* labels, int count) {
  if (node.block() == nullptr) {
    const VoxelLabel label = VoxelLabel::from_id(node.label_id());
    std::fill_n(labels, count, label);
    return label.any();
  }
  const int each = count / static_cast<int>(SemanticNode::kChildren);
  bool any = false;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i)
    any = read_labels(node.block()[i], labels + static_cast<int>(i) * each, each) || any;
  return any;
}

}  // namespace

bool read_labels(const SemanticNode& node, TileLabels& labels) { return read_labels(node, labels.data(), kTileVoxels); }

// NOLINTNEXTLINE(misc-no-recursion)
void read_voxels(const SemanticNode& node, float* voxels, int count) {
  const SemanticNode* block = node.block();
  if (block == nullptr) {
    std::fill_n(voxels, count, node.getLogOdds());
    return;
  }
  const int each = count / static_cast<int>(SemanticNode::kChildren);
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    if (each == 1)
      voxels[i] = block[i].getLogOdds();
    else
      read_voxels(block[i], voxels + static_cast<int>(i) * each, each);
  }
}

bool write_voxels(const TileVoxels& voxels, NodeWriter& writer, SemanticNode* leaf, const TileLabels* labels) {
  if (nothing_known(voxels.data(), kTileVoxels)) return false;
  write_voxels(voxels.data(), labels != nullptr ? labels->data() : nullptr, kTileVoxels, writer, leaf);
  return true;
}

}  // namespace cairn::mapping
