// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::report {

/// Distance from a point to the nearest centre of an occupied voxel, in metres; none beyond `max_distance_m`.
/// Branch and bound: relies on inner nodes being the maximum of their children (is_canonical()).
[[nodiscard]] std::optional<double> distance_to_occupied(const mapping::SemanticOcTree& map,
                                                         const Eigen::Vector3d& point, double max_distance_m);

/// How a map is compared with the true map.
struct MapErrorOptions {
  SE3 T_truth_map;            ///< the map's frame in the true map's frame
  double tolerance_m = 0;     ///< how far a voxel may be off and still be right; 0: the diagonal of a voxel of the map
  double max_distance_m = 1;  ///< distances above this count as this
};

/// Figures of `cairn evaluate map`: how well the occupied voxels of a map lie on those of the true map.
struct MapError {
  std::uint64_t occupied = 0;       ///< voxels of the map
  std::uint64_t correct = 0;        ///< of these, with a true one within the tolerance
  double mean_m = 0, rmse_m = 0;    ///< distance from the map's voxels to the true ones
  std::uint64_t true_occupied = 0;  ///< voxels of the true map
  std::uint64_t found = 0;          ///< of these, with one of the map within the tolerance
  std::uint64_t contradicted = 0;   ///< of these, free in the map
  std::uint64_t unseen = 0;         ///< of these, unknown in the map

  [[nodiscard]] std::optional<double> precision() const;
  /// found / (found + contradicted): what was never seen is not held against the map.
  [[nodiscard]] std::optional<double> recall() const;
};
/// Error: more occupied voxels than can be listed.
[[nodiscard]] Result<MapError> map_error(const mapping::SemanticOcTree& map, const mapping::SemanticOcTree& truth,
                                         const MapErrorOptions& options);

}  // namespace cairn::report
