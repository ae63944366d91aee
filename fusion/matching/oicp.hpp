// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/matching/voxel_matcher.hpp"

namespace cairn::matching {

/// Occupancy iterative closest point (ch. 3), as printed: 15 iterations of point-to-plane ICP (3.2), then up to 35 with
/// pairs that are nearest in (x, y, z, √ω_o·p) (3.9) and the closed form. ω_o = MSE/H(m) (3.16, k = 1) never grows, as
/// the proof of convergence needs. For comparison: it descends from one start, and to the nearest parallel wall.
class Oicp final : public VoxelMatcher {
 public:
  Oicp(const MapFeatures& a, const MapFeatures& b);

 private:
  [[nodiscard]] SE3 descend(const UncertainPose& prior, Budget& budget) const override;
  [[nodiscard]] std::optional<SE3> plane_step(const SE3& T) const;

  std::vector<Eigen::Vector3f> normals_a_;
};

}  // namespace cairn::matching
