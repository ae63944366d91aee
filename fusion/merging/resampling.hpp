// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "hal/se3.hpp"
#include "onboard/mapping/semantic_octree.hpp"

namespace cairn::merging {

/// What a map says about all voxels of a cube.
struct Content {
  enum class Kind : std::uint8_t { kUnknown, kUniform, kMixed };
  Kind kind = Kind::kUnknown;
  float log_odds = 0;  ///< where uniform

  friend bool operator==(const Content&, const Content&) = default;
};

/// A map seen in another grid: each voxel there has the value of the voxel its centre falls into (nearest neighbour).
/// The tree must outlive the view and not be edited.
class Resampled {
 public:
  /// A node of the tree that holds everything a cube touches: where to look next for what lies inside the cube.
  struct Place {
    const SemanticNode* node;
    Eigen::Vector3i first;  ///< lowest voxel key
    int edge;               ///< voxels
  };
  /// Voxel keys, both ends inclusive.
  struct Box {
    Eigen::Vector3i low, high;
  };

  /// Cubes will be given in voxels of `grid_resolution_m`, counted from the corner of the grid's tree.
  Resampled(const SemanticOcTree& map, const SE3& T_grid_map, double grid_resolution_m);

  [[nodiscard]] Place root() const;
  /// What the cube of `edge`³ voxels from `first` on holds. `place` is one that holds it, and becomes a smaller one.
  [[nodiscard]] Content look(const Eigen::Vector3i& first, int edge, Place& place) const;
  /// The same for the eight voxels of a cube of edge 2, in the order of a node's children; SemanticNode::kAbsent where
  /// nothing is known. `place` is one that holds the cube. Nearly all of a map is voxels, so this is what merging
  /// costs.
  [[nodiscard]] std::array<float, 8> octet(const Eigen::Vector3i& first, Place place) const;

 private:
  /// Voxels of the map that the eight centres of a cube of edge 2 fall into; −1 outside of its tree.
  [[nodiscard]] Eigen::Array<int, 3, 8> keys_of(const Eigen::Vector3i& first) const;
  [[nodiscard]] Box box_of(const Eigen::Vector3i& first, int edge) const;

  [[nodiscard]] Content look_aligned(const Eigen::Vector3i& first, int edge, Place& place) const;

  const SemanticNode* root_;
  bool aligned_;                             // the map's voxels are the grid's: each cube is a node or lies in a leaf
  Eigen::Matrix3d scaled_rotation_, reach_;  // from voxels of the grid to voxels of the map
  Eigen::Vector3d offset_;
};

}  // namespace cairn::merging
