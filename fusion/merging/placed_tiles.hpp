// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::merging {

/// One tile of one submap, and when it came.
struct ReceivedTile {
  mapping::TileState state;
  Time stamp{};
};
/// Tiles of one submap, in its own frame.
using TileLayer = std::map<mapping::TileKey, ReceivedTile>;

/// A box of tiles, in tiles from the corner of the tree, both ends inclusive. It may reach beyond the tree.
struct TileBox {
  Eigen::Vector3i low, high;
};

/// Where a submap lies in the grid of a team's map. It computes in whole numbers, so it is the same on every machine.
/// Both grids have the same resolution. A voxel of the team's grid has the value of the submap's voxel that its centre
/// falls into.
class Placement {
 public:
  /// Nothing for a pose that is not finite, or beyond a tree's ±2¹⁵ voxels.
  [[nodiscard]] static std::optional<Placement> of(const SE3& T_team_submap, double resolution_m);

  /// The team's tiles that a tile of the submap may reach into.
  [[nodiscard]] TileBox touched_by(mapping::TileKey tile) const;
  /// What a submap knows of one of the team's tiles.
  struct Opinion {
    mapping::TileVoxels voxels;
    bool labelled = false;
    mapping::TileLabels labels;  ///< if labelled
  };
  /// False if the submap knows nothing of the team's tile.
  [[nodiscard]] bool read(const TileLayer& layer, mapping::TileKey tile, Opinion& opinion) const;

  /// The submap's tiles that may reach into one of the team's.
  [[nodiscard]] TileBox sources_of(mapping::TileKey tile) const;

  friend bool operator==(const Placement&, const Placement&) = default;

 private:
  /// From the centre of a voxel of one grid to a place in the other, in voxels · 2³⁰ from the origin.
  struct Motion {
    std::array<std::array<std::int64_t, 3>, 3> rotation{};
    std::array<std::int64_t, 3> offset{};
    friend bool operator==(const Motion&, const Motion&) = default;
  };
  using Fixed = std::array<std::int64_t, 3>;
  static Motion motion(const SE3& T, double resolution_m);
  [[nodiscard]] Fixed first_centre(mapping::TileKey tile) const;
  static Fixed moved(const Motion& motion, const std::array<int, 3>& twice_voxels);

  Motion submap_from_team_, team_from_submap_;
};

}  // namespace cairn::merging
