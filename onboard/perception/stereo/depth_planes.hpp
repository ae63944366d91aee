// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "onboard/perception/stereo/disparity_field.hpp"

namespace cairn::stereo {

/// The pixels of a depth picture that become points: a pinhole, of which every `step_px`th column and row is taken.
struct DepthGrid {
  int width = 0, height = 0;              ///< pixels
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< focal lengths and principal point, pixels
  int step_px = 1;
};

/// Takes noise out of a depth camera's points: each one is put onto the plane through it and its neighbours in the
/// picture. The noise of such a camera is that of a disparity, so planes are fitted to 1 / depth; see DisparityField.
/// Points that hardly a neighbour agrees with are left out: they hang in the air between near and far.
class DepthPlanes {
 public:
  explicit DepthPlanes(const DepthGrid& grid) : grid_(grid) {}

  /// Points of one picture, metres in the camera's frame: x along the view, y to the left, z up. Memory is reused.
  void smooth(std::vector<Eigen::Vector3f>& points);

 private:
  /// Column and row among the samples.
  [[nodiscard]] Eigen::Vector2i sample_of(const Eigen::Vector3f& point) const;

  DepthGrid grid_;
  DisparityField field_;
};

}  // namespace cairn::stereo
