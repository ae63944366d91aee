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
  TileState state;
  Time stamp{};
};
/// Tiles of one submap, in its own frame.
using TileLayer = std::map<TileKey, ReceivedTile>;

/// Tile coordinates, in tiles from the corner of the tree; both ends inclusive. They may lie outside of it.
struct TileBox {
  Eigen::Vector3i low, high;
};

/// Where a submap lies in the grid of a team's map, in whole numbers: the same on every machine. Both grids have the
/// same resolution. A voxel of the grid has the value of the submap's voxel its centre falls into.
class Placement {
 public:
  /// Nothing for poses that are not finite or reach beyond a tree's ±2¹⁵ voxels.
  [[nodiscard]] static std::optional<Placement> of(const SE3& T_team_submap, double resolution_m);

  /// The team's tiles that a submap's tile can have a say in.
  [[nodiscard]] TileBox touched_by(TileKey tile) const;
  /// What a submap says of one of the team's tiles.
  struct Said {
    TileVoxels voxels;
    bool labelled = false;
    TileLabels labels;  ///< where any
  };
  /// False where that is nothing.
  [[nodiscard]] bool read(const TileLayer& layer, TileKey tile, Said& said) const;

  /// The submap's tiles that can have a say in one of the team's.
  [[nodiscard]] TileBox sources_of(TileKey tile) const;

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
  [[nodiscard]] Fixed first_centre(TileKey tile) const;
  static Fixed moved(const Motion& motion, const std::array<int, 3>& twice_voxels);

  Motion submap_from_team_, team_from_submap_;
};

}  // namespace cairn::merging
