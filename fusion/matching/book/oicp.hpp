// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/book/voxel_matcher.hpp"

namespace cairn::matching {

/// Occupancy iterative closest point (ch. 3), as printed:
/// 1. 15 iterations of point-to-plane ICP (3.2).
/// 2. Up to 35 iterations with pairs that are nearest in (x, y, z, √ω_o·p) (3.9), in closed form.
///
/// ω_o = MSE/H(m) (3.16, k = 1) never grows, which the proof of convergence needs. The method
/// descends from one start, often to the nearest parallel wall.
class Oicp : public VoxelMatcher {
 public:
  Oicp(const MapFeatures& a, const MapFeatures& b) : Oicp(a, b, {}) {}

 protected:
  /// How long each stage runs.
  struct Stages {
    /// Of the two stages, at most (section 3.4.1).
    int plane_iterations = 15, closed_iterations = 35;
    /// Counts in the association of the second stage.
    bool occupancy = true;
  };
  Oicp(const MapFeatures& a, const MapFeatures& b, const Stages& stages);

 private:
  [[nodiscard]] SE3 descend(const UncertainPose& prior, Budget& budget) const override;
  [[nodiscard]] std::optional<SE3> plane_step(const SE3& T) const;

  Stages stages_;
  std::vector<Eigen::Vector3f> normals_a_;
};

/// ICP between voxels, point to point or point to plane: the book's Table 4.3, 30 iterations each.
class Icp final : public Oicp {
 public:
  Icp(const MapFeatures& a, const MapFeatures& b)
      : Oicp(a, b, {.plane_iterations = 0, .closed_iterations = kIterations, .occupancy = false}) {}
};
/// Point-to-plane ICP, for comparison.
class PlaneIcp final : public Oicp {
 public:
  PlaneIcp(const MapFeatures& a, const MapFeatures& b)
      : Oicp(a, b, {.plane_iterations = kIterations, .closed_iterations = 0, .occupancy = false}) {}
};

}  // namespace cairn::matching
