// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/perception/cameras/distortion.hpp"

namespace cairn::cameras {

/// Numbers of a pinhole camera. Pixels count as in calibration files (OpenCV, ROS, Kalibr): the centre of the upper
/// left pixel is (0, 0), and the picture reaches from −0.5 to width − 0.5.
struct CameraParameters {
  int width = 0, height = 0;              ///< pixels
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< focal lengths and principal point, pixels
  Distortion distortion;
};

/// Where a camera sees a point. The optical frame is REP-103's: x to the right, y down, z along the view.
class CameraModel {
 public:
  static constexpr int kMaxSide = 16384;  ///< pixels

  /// Error kInvalidConfig with all faults, one line each: numbers that are not finite, sizes or focal lengths that are
  /// not positive, a distortion that turns back at once.
  [[nodiscard]] static Result<CameraModel> create(const CameraParameters& parameters);

  /// The pixel of a point of the optical frame, metres. None if the point is behind the camera, outside of the picture,
  /// or so far from the axis that the distortion has no meaning there.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point_optical) const;
  /// Unit vector in the optical frame along which the camera sees this pixel. Any pixel is allowed, also outside of the
  /// picture. None: no ray goes there.
  [[nodiscard]] std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const;

  /// The same camera for a picture of another size, whose pixels stand for equal rectangles of this one.
  [[nodiscard]] CameraModel scaled(int width, int height) const;

  [[nodiscard]] const CameraParameters& parameters() const { return p_; }
  [[nodiscard]] int width() const { return p_.width; }
  [[nodiscard]] int height() const { return p_.height; }
  [[nodiscard]] bool in_picture(const Eigen::Vector2d& pixel) const;

 private:
  explicit CameraModel(const CameraParameters& parameters);

  CameraParameters p_;
  double limit_;  // of the ideal radius
};

/// What takes a point of the optical frame to the camera's REP-103 body frame (x along the view, y left, z up), in
/// which profiles give mounts.
[[nodiscard]] SE3 T_camera_optical();

}  // namespace cairn::cameras
