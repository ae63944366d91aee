// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "hal/se3.hpp"
#include "onboard/perception/stereo/row_motion.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"

namespace cairn::visual_odometry {

/// A landmark that is nearer to the eye, along its axis, says nothing; it may as well be behind it.
inline constexpr double kNearest_m = 0.1;

/// Where both eyes see a landmark (left pixel, disparity), and how that changes.
struct LandmarkView {
  Eigen::Vector3d expected;
  Eigen::Matrix<double, 3, 6> by_pose;  ///< by a right perturbation of T_odom_base
  Eigen::Matrix3d by_point;             ///< by the landmark's place in odom
};

/// Where a row shows the landmark that is exposed after `motion`. False where the landmark is nearer than kNearest_m.
inline bool view_landmark(const stereo::StereoGeometry& geometry, const SE3& T_eye_base, const SE3& T_base_odom,
                          const Eigen::Vector3d& p_odom, const stereo::RowMotion& motion, LandmarkView& out) {
  const Eigen::Vector3d p_base = motion.at_row(T_base_odom * p_odom);
  const Eigen::Vector3d p_eye = T_eye_base * p_base;
  if (p_eye.z() < kNearest_m) return false;
  const Eigen::Matrix3d by_base = geometry.jacobian(p_eye) * T_eye_base.rotation();
  out.expected = geometry.project(p_eye);
  out.by_pose << -by_base, by_base * hat(p_base);
  out.by_point = by_base * T_base_odom.rotation();
  return true;
}

}  // namespace cairn::visual_odometry
