// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/voxel_positions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "onboard/mapping/files/point_file.hpp"
#include "onboard/mapping/tree/key_at.hpp"

namespace cairn::merging {
namespace {

constexpr double kMost = 0.95;  // of the voxels are known better than the percentile that is told

Eigen::Vector3d centre_of(const mapping::SemanticOcTree& map, const octomap::OcTreeKey& key) {
  return {map.keyToCoord(key[0]), map.keyToCoord(key[1]), map.keyToCoord(key[2])};
}

/// A map, ready for many questions.
class Witness {
 public:
  explicit Witness(const PlacedMap& placed) : placed_(placed), T_map_fused_(placed.T_fused_map.mean.inverse()) {}

  /// What the map says of the voxel with this centre; nothing if it does not call it occupied.
  [[nodiscard]] std::optional<Position> of(const Eigen::Vector3d& centre) const {
    const mapping::SemanticOcTree& map = *placed_.map;
    const Eigen::Vector3d here = T_map_fused_ * centre;
    const auto key = mapping::key_at(map, here);
    const mapping::SemanticNode* voxel = key ? map.search(*key) : nullptr;
    if (voxel == nullptr || !map.isNodeOccupied(voxel)) return std::nullopt;
    const Position own{centre_of(map, *key), voxel_covariance(voxel->getOccupancy(), map.getResolution())};
    return moved(placed_.T_fused_map, own);
  }

 private:
  const PlacedMap& placed_;
  SE3 T_map_fused_;
};

VoxelPosition position_of(const Eigen::Vector3d& centre, double occupancy, double edge_m,
                          std::span<const Witness> witnesses) {
  VoxelPosition voxel;
  for (const Witness& witness : witnesses) {
    const auto said = witness.of(centre);
    if (!said) continue;
    voxel.alone_m = voxel.maps == 0 ? rms_m(*said) : std::min(voxel.alone_m, rms_m(*said));
    voxel.position = voxel.maps++ == 0 ? *said : product(voxel.position, *said);
  }
  if (voxel.maps > 0) return voxel;
  voxel.position = {centre, voxel_covariance(occupancy, edge_m)};
  voxel.alone_m = rms_m(voxel.position);
  return voxel;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

}  // namespace

double rms_m(const Position& position) { return std::sqrt(position.covariance.trace()); }

Result<std::vector<VoxelPosition>> voxel_positions(const mapping::SemanticOcTree& fused,
                                                   std::span<const PlacedMap> maps) {
  const auto voxels = mapping::listable_voxels(fused);
  if (!voxels) return voxels.error();
  const std::vector<Witness> witnesses(maps.begin(), maps.end());
  std::vector<VoxelPosition> positions;
  positions.reserve(*voxels);
  mapping::for_each_occupied_voxel(fused, [&](const Eigen::Vector3f& centre, const mapping::SemanticNode& leaf) {
    positions.push_back(position_of(centre.cast<double>(), leaf.getOccupancy(), fused.getResolution(), witnesses));
  });
  return positions;
}

mapping::PositionFigures position_figures(std::span<const VoxelPosition> positions) {
  std::vector<double> all, shared, alone;
  for (const VoxelPosition& voxel : positions) {
    all.push_back(rms_m(voxel.position));
    if (voxel.maps < 2) continue;
    shared.push_back(all.back());
    alone.push_back(voxel.alone_m);
  }
  mapping::PositionFigures figures{.voxels = all.size(),
                                   .shared = shared.size(),
                                   .mean_m = mean(all),
                                   .shared_mean_m = mean(shared),
                                   .shared_alone_m = mean(alone)};
  if (all.empty()) return figures;
  const auto most = all.begin() + static_cast<std::ptrdiff_t>(kMost * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), most, all.end());
  figures.p95_m = *most;
  return figures;
}

}  // namespace cairn::merging
