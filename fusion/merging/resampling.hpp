// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "fusion/merging/tile_window.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::merging {

/// What a map knows of all voxels of a cube.
struct Content {
  enum class Kind : std::uint8_t { kUnknown, kUniform, kMixed };
  Kind kind = Kind::kUnknown;
  float log_odds = 0;  ///< if uniform

  friend bool operator==(const Content&, const Content&) = default;
};

/// A map in another grid: each voxel there has the value of the voxel that its centre falls into (nearest neighbour).
/// The tree must outlive it, and must not be edited.
class Resampled {
 public:
  /// A node of the tree that holds all that a cube touches. The search inside the cube goes on from it.
  struct Place {
    const mapping::SemanticNode* node;
    Eigen::Vector3i first;  ///< lowest voxel key
    int edge;               ///< voxels
  };
  /// Voxel keys, both ends inclusive.
  struct Box {
    Eigen::Vector3i low, high;
  };

  /// Cubes are given in voxels of `grid_resolution_m`, counted from the corner of the grid's tree. These voxels are not
  /// larger than the map's.
  Resampled(const mapping::SemanticOcTree& map, const SE3& T_grid_map, double grid_resolution_m);

  [[nodiscard]] Place root() const;
  /// What the cube of `edge`³ voxels from `first` on holds. `place` holds the cube, and becomes a smaller place that
  /// does.
  [[nodiscard]] Content look(const Eigen::Vector3i& first, int edge, Place& place) const;
  /// The voxels of a tile that look() has called mixed; `place` is the one it gave. Merging spends most of its time
  /// here.
  void read(const Eigen::Vector3i& first, const Place& place, mapping::TileVoxels& tile);

 private:
  void measure_steps();
  [[nodiscard]] Box box_of(const Eigen::Vector3i& first, int edge) const;
  void read_turned(const Eigen::Vector3i& first, mapping::TileVoxels& tile);
  [[nodiscard]] Content look_aligned(const Eigen::Vector3i& first, int edge, Place& place) const;

  const mapping::SemanticNode* root_;
  bool aligned_;                             // the map's voxels are the grid's: each cube is a node or lies in a leaf
  Eigen::Matrix3d scaled_rotation_, reach_;  // from voxels of the grid to voxels of the map
  Eigen::Vector3d offset_;
  // From a tile's first voxel to each of its voxels, by axis.
  std::array<std::array<double, mapping::kTileVoxels>, 3> steps_{};
  Eigen::Vector3d least_step_, greatest_step_;
  TileWindow window_;
};

}  // namespace cairn::merging
