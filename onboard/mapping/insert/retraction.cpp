// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/retraction.hpp"

#include <algorithm>

namespace cairn::mapping {

std::size_t Retraction::take_back(std::span<const Eigen::Vector3f> points_map, SemanticOcTree& tree,
                                  std::vector<TileKey>& changed) {
  placed_.clear();
  for (std::size_t i = 0; i < points_map.size(); ++i)
    (void)place_point(tree, points_map[i], static_cast<std::uint32_t>(i), placed_);
  sort_by_voxel(placed_);
  const SensorModel model = tree.sensor_model();
  std::size_t voxels = 0;
  OccupiedWalk walk(tree, [&](SemanticNode& voxel, PlacedPoints points) {
    const float before = voxel.getLogOdds();
    voxel.setLogOdds(std::clamp(before - model.hit + model.miss, model.min, model.max));
    ++voxels;
    if (voxel.getLogOdds() >= model.occupied) return true;
    voxel.set_label_id(0);
    const TileKey tile{points.front().path >> (3 * TileKey::kVoxelBits)};
    if (changed.empty() || changed.back() != tile) changed.push_back(tile);
    return true;
  });
  (void)walk.run(placed_);
  return voxels;
}

}  // namespace cairn::mapping
