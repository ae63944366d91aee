// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/tree/occupied_walk.hpp"

#include "onboard/mapping/tree/key_at.hpp"

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
  const auto key = key_at(tree, point.cast<double>());
  if (key) placed.push_back({voxel_path(*key), index});
  return key.has_value();
}

void sort_by_voxel(std::vector<PlacedPoint>& placed) {
  std::ranges::sort(placed, [](const PlacedPoint& a, const PlacedPoint& b) {
    return a.path != b.path ? a.path < b.path : a.point < b.point;
  });
}

}  // namespace cairn::mapping
