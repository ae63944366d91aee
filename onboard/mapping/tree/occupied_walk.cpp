// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/occupied_walk.hpp"

namespace cairn::mapping {

std::uint64_t voxel_path(const octomap::OcTreeKey& key) {
  std::uint64_t path = 0;
  for (unsigned bit = 0; bit < SemanticOcTree::kDepth; ++bit) {
    const std::uint64_t digit = (key[0] >> bit & 1U) | (key[1] >> bit & 1U) << 1U | (key[2] >> bit & 1U) << 2U;
    path |= digit << (3 * bit);
  }
  return path;
}

bool place_point(const SemanticOcTree& tree, const Eigen::Vector3f& point, std::uint32_t index,
                 std::vector<PlacedPoint>& placed) {
  // OctoMap converts to int before it looks whether that is possible. NaN is not within, either.
  const auto farthest = static_cast<float>(tree.getResolution() * (1U << (SemanticOcTree::kDepth - 1)));
  octomap::OcTreeKey key;
  if (!(point.array().abs() < farthest).all() || !tree.coordToKeyChecked(point.x(), point.y(), point.z(), key))
    return false;
  placed.push_back({voxel_path(key), index});
  return true;
}

void sort_by_voxel(std::vector<PlacedPoint>& placed) {
  std::ranges::sort(placed, [](const PlacedPoint& a, const PlacedPoint& b) {
    return a.path != b.path ? a.path < b.path : a.point < b.point;
  });
}

}  // namespace cairn::mapping
