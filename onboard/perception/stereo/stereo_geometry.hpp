// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace cairn::stereo {

/// Two ideal pinhole cameras side by side, whose rows correspond. The optical frame is the left eye's: x to the right,
/// y down, z along the view, metres. Pixels count as in CameraParameters.
struct StereoGeometry {
  int width = 0, height = 0;              ///< pixels of one eye
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< focal lengths and principal point of both eyes, pixels
  double baseline_m = 0;                  ///< the right eye stands so far to the right of the left one
  double line_time_s = 0;  ///< rolling shutter: from the exposure of one row to that of the next; 0: all at once

  /// From a picture's stamp, which is the exposure of its first row, to the exposure of this row.
  [[nodiscard]] double after_stamp_s(double row) const { return line_time_s * row; }

  /// Left pixel and disparity of a point with z > 0.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& p) const {
    const double inverse = 1 / p.z();
    return {fx * p.x() * inverse + cx, fy * p.y() * inverse + cy, fx * baseline_m * inverse};
  }
  /// The point of a left pixel with a disparity > 0.
  [[nodiscard]] Eigen::Vector3d point(double x, double y, double disparity) const {
    const double z = fx * baseline_m / disparity;
    return {(x - cx) / fx * z, (y - cy) / fy * z, z};
  }
  /// Derivative of project().
  [[nodiscard]] Eigen::Matrix3d jacobian(const Eigen::Vector3d& p) const {
    const double i = 1 / p.z();
    Eigen::Matrix3d J;
    J << fx * i, 0, -fx * p.x() * i * i, 0, fy * i, -fy * p.y() * i * i, 0, 0, -fx * baseline_m * i * i;
    return J;
  }
};

}  // namespace cairn::stereo
