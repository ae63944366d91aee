// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/tile_window.hpp"

#include <algorithm>

namespace cairn::merging {
namespace {

constexpr int kTilesAcross = (1 << mapping::SemanticOcTree::kDepth) / mapping::kTileEdge;

}  // namespace

void TileWindow::hold(const Eigen::Vector3i& low, const Eigen::Vector3i& high) {
  if (voxels_.empty()) {
    voxels_.resize(kTiles * mapping::kTileVoxels);
    held_.resize(kTiles, Eigen::Vector3i::Constant(kTilesAcross + 1));
  }
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) {
        const Eigen::Vector3i tile(x, y, z);
        const int at =
            index(0, x * mapping::kTileEdge) + index(1, y * mapping::kTileEdge) + index(2, z * mapping::kTileEdge);
        Eigen::Vector3i& held = held_[static_cast<std::size_t>(at / mapping::kTileVoxels)];
        if (held == tile) continue;
        held = tile;
        read(tile, voxels_.data() + at);
      }
}

void TileWindow::read(const Eigen::Vector3i& tile, float* into) const {
  const bool outside = (tile.array() < 0).any() || (tile.array() >= kTilesAcross).any();
  if (root_ == nullptr || outside) {
    std::fill_n(into, mapping::kTileVoxels, mapping::SemanticNode::kAbsent);
    return;
  }
  const mapping::SemanticNode* node = root_;
  for (int half = kTilesAcross / 2; half > 0 && node->block() != nullptr; half /= 2) {
    const auto upper = [&](int axis) { return (tile[axis] & half) != 0 ? 1 << axis : 0; };
    node = node->block() + (upper(0) | upper(1) | upper(2));
  }
  mapping::read_voxels(*node, into, mapping::kTileVoxels);
}

}  // namespace cairn::merging
