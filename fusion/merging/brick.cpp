// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/brick.hpp"

#include <algorithm>

namespace cairn::merging {
namespace {

constexpr int kBricksAcross = (1 << SemanticOcTree::kDepth) / kBrickEdge;

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

void read_brick(const SemanticNode& node, Brick& brick) { read_voxels(node, brick.data(), kBrickVoxels); }

bool write_brick(const Brick& brick, NodeWriter& writer, SemanticNode* leaf) {
  if (nothing_known(brick.data(), kBrickVoxels)) return false;
  write_voxels(brick.data(), kBrickVoxels, writer, leaf);
  return true;
}

void BrickWindow::hold(const Eigen::Vector3i& low, const Eigen::Vector3i& high) {
  if (voxels_.empty()) {
    voxels_.resize(kBricks * kBrickVoxels);
    held_.resize(kBricks, Eigen::Vector3i::Constant(kBricksAcross + 1));
  }
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) {
        const Eigen::Vector3i brick(x, y, z);
        const int at = index(0, x * kBrickEdge) + index(1, y * kBrickEdge) + index(2, z * kBrickEdge);
        Eigen::Vector3i& held = held_[static_cast<std::size_t>(at / kBrickVoxels)];
        if (held == brick) continue;
        held = brick;
        read(brick, voxels_.data() + at);
      }
}

void BrickWindow::read(const Eigen::Vector3i& brick, float* into) const {
  const bool outside = (brick.array() < 0).any() || (brick.array() >= kBricksAcross).any();
  if (root_ == nullptr || outside) {
    std::fill_n(into, kBrickVoxels, SemanticNode::kAbsent);
    return;
  }
  const SemanticNode* node = root_;
  for (int half = kBricksAcross / 2; half > 0 && node->block() != nullptr; half /= 2) {
    const auto upper = [&](int axis) { return (brick[axis] & half) != 0 ? 1 << axis : 0; };
    node = node->block() + (upper(0) | upper(1) | upper(2));
  }
  read_voxels(*node, into, kBrickVoxels);
}

}  // namespace cairn::merging
