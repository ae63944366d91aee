// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "onboard/mapping/tree/map_tile.hpp"
#include "onboard/mapping/tree/occupied_walk.hpp"

namespace cairn::mapping {

/// Takes back what points of one scan have put into the map: each of their voxels that is occupied counts as if a ray
/// had gone through it, instead of having ended there. For points that turn out to be of something that moves.
class Retraction {
 public:
  /// `tree` stays canonical. Adds to `changed` the tiles in which a voxel became free, in canonical order. Returns the
  /// number of voxels that changed.
  std::size_t take_back(std::span<const Eigen::Vector3f> points_map, SemanticOcTree& tree,
                        std::vector<TileKey>& changed);

 private:
  std::vector<PlacedPoint> placed_;  // reused
};

}  // namespace cairn::mapping
