// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::labelling {

/// Where the robot was when a picture was taken.
struct Exposure {
  SE3 T_odom_base;                  ///< when the first row was exposed
  Vector6 twist = Vector6::Zero();  ///< of base_link in base_link, m/s and rad/s; for rolling shutters alone
};

/// A point in the picture.
struct Projected {
  std::uint32_t index = 0;  ///< of the point in its scan
  float u = 0, v = 0;       ///< pixel, as CameraModel counts
  float depth = 0;          ///< m along the view
  float range = 0;          ///< m from the camera
};

/// Projects the points of a scan into a picture: to where the camera was when the picture was taken, or, with a rolling
/// shutter, when the point's row was. Memory is reused from scan to scan.
class Projection {
 public:
  /// `T_base_camera`: the mount, in body axes (x along the view). `line_time_us`: between rows; 0: a global shutter.
  Projection(const cameras::CameraModel& camera, const SE3& T_base_camera, double line_time_us);

  /// The points that the camera sees, in the scan's order; occlusion is not looked at. Valid until the next call.
  std::span<const Projected> project(std::span<const Eigen::Vector3f> points_base, const SE3& T_odom_scan,
                                     const Exposure& exposure);
  [[nodiscard]] const cameras::CameraModel& camera() const { return camera_; }

 private:
  /// A rigid motion, ready to be applied to very many points.
  struct Motion {
    Eigen::Matrix3d R;
    Eigen::Vector3d t;
    Eigen::Vector3d operator*(const Eigen::Vector3f& p) const { return R * p.cast<double>() + t; }
  };
  [[nodiscard]] Motion to_camera(const SE3& T_odom_scan, const Exposure& exposure, double row) const;
  void add(std::uint32_t index, const Eigen::Vector3d& point_optical);
  void add_rolling(std::uint32_t index, const Eigen::Vector3f& point);

  cameras::CameraModel camera_;
  SE3 T_optical_base_;
  double line_time_s_;
  std::vector<Motion> rows_;  // of each row, with a rolling shutter
  std::vector<Projected> seen_;
};

}  // namespace cairn::labelling
