// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/book/voxel_matcher.hpp"

namespace cairn::matching {

/// Occupancy iterative closest point (ch. 3), as printed: 15 iterations of point-to-plane ICP (3.2), then up to 35 with
/// pairs that are nearest in (x, y, z, √ω_o·p) (3.9) and the closed form. ω_o = MSE/H(m) (3.16, k = 1) never grows, as
/// the proof of convergence needs. For comparison: it descends from one start, and to the nearest parallel wall.
class Oicp : public VoxelMatcher {
 public:
  Oicp(const MapFeatures& a, const MapFeatures& b) : Oicp(a, b, {}) {}

 protected:
  struct Stages {
    int plane_iterations = 15, closed_iterations = 35;
    bool occupancy = true;  ///< counts in the association of the second stage
  };
  Oicp(const MapFeatures& a, const MapFeatures& b, const Stages& stages);

 private:
  [[nodiscard]] SE3 descend(const UncertainPose& prior, Budget& budget) const override;
  [[nodiscard]] std::optional<SE3> plane_step(const SE3& T) const;

  Stages stages_;
  std::vector<Eigen::Vector3f> normals_a_;
};

/// ICP between voxels, point to point, and point to plane: the book's Table 4.3, 30 iterations each.
class Icp final : public Oicp {
 public:
  Icp(const MapFeatures& a, const MapFeatures& b) : Oicp(a, b, {0, 30, false}) {}
};
class PlaneIcp final : public Oicp {
 public:
  PlaneIcp(const MapFeatures& a, const MapFeatures& b) : Oicp(a, b, {30, 0, false}) {}
};

}  // namespace cairn::matching
