// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/merging/position.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/position_figures.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::merging {

/// A map and where it lies in a fused one. A pose that is exact has covariance 0.
struct PlacedMap {
  const mapping::SemanticOcTree* map = nullptr;  ///< borrowed
  UncertainPose T_fused_map;                     ///< covariance of the right perturbation
};

/// Where an occupied voxel of a fused map is.
struct VoxelPosition {
  Position position;   ///< in the fused map's frame
  int maps = 0;        ///< that say it is occupied
  double alone_m = 0;  ///< rms_m() by the map that knows it best, taken alone
};
/// How far something is from where it is said to be, as a root mean square: √trace of the covariance, m.
[[nodiscard]] double rms_m(const Position& position);

/// Where each occupied voxel of `fused` is, and how well that is known (5.14 to 5.17), in canonical order. Each map
/// whose voxel there is occupied gives the place of that voxel: its own uncertainty, and that of the map's pose on top.
/// The fused place is their product. Where no map says so, the fused voxel is alone. So a voxel that two maps know is
/// known better than by either, and one far from where a map's pose is certain worse than one nearby. Errors of one
/// pose are common to all voxels of a map, so neighbours are not independent. Errors: those of
/// mapping::listable_voxels().
[[nodiscard]] Result<std::vector<VoxelPosition>> voxel_positions(const mapping::SemanticOcTree& fused,
                                                                 std::span<const PlacedMap> maps);

/// rms_m() over the voxels of a fused map.
[[nodiscard]] mapping::PositionFigures position_figures(std::span<const VoxelPosition> positions);

}  // namespace cairn::merging
