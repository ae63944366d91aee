// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tile_voxels.hpp"

#include <algorithm>

namespace cairn {
namespace {

bool nothing_known(const float* voxels, int count) {
  return std::all_of(voxels, voxels + count, [](float v) { return v == SemanticNode::kAbsent; });
}

/// Of voxels of which at least one is known.
// NOLINTNEXTLINE(misc-no-recursion)
void write_voxels(const float* voxels, int count, NodeWriter& writer, SemanticNode* node) {
  writer.add_block(node);
  const int each = count / static_cast<int>(SemanticNode::kChildren);
  std::ptrdiff_t made = 0;
  for (unsigned i = 0; i < SemanticNode::kChildren; ++i) {
    const float* of_child = voxels + static_cast<int>(i) * each;
    if (nothing_known(of_child, each)) continue;
    ++made;
    if (each == 1)
      node->block()[i].setLogOdds(*of_child);
    else
      write_voxels(of_child, each, writer, node->block() + i);
  }
  writer.count(made);
  writer.refresh(node);
}

}  // namespace

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

bool write_voxels(const TileVoxels& voxels, NodeWriter& writer, SemanticNode* leaf) {
  if (nothing_known(voxels.data(), kTileVoxels)) return false;
  write_voxels(voxels.data(), kTileVoxels, writer, leaf);
  return true;
}

}  // namespace cairn
