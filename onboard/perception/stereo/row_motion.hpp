// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "hal/se3.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"

namespace cairn::stereo {

/// How base_link moves from the stamp of a picture until a rolling shutter exposes one of its rows. To first order:
/// that takes some hundredths of a second.
struct RowMotion {
  Vector6 twist = Vector6::Zero();  ///< of base_link in base_link: m/s, rad/s
  double after_s = 0;               ///< from the stamp to the exposure of the row

  /// A point of the surroundings, given in base_link at the stamp: in base_link when the row is exposed.
  [[nodiscard]] Eigen::Vector3d at_row(const Eigen::Vector3d& p_base) const { return p_base - after_s * speed(p_base); }
  /// The other way round.
  [[nodiscard]] Eigen::Vector3d at_stamp(const Eigen::Vector3d& p_row) const { return p_row + after_s * speed(p_row); }

 private:
  [[nodiscard]] Eigen::Vector3d speed(const Eigen::Vector3d& p) const {
    return twist.head<3>() + twist.tail<3>().cross(p);
  }
};

/// Moves the points of a picture to where they would be, had all rows been exposed with the first one. `points_eye`:
/// the points in the optical frame, which tell their rows; `points_base`: the same points in base_link, m.
void hold_still(const StereoGeometry& geometry, const Vector6& twist, std::span<const Eigen::Vector3f> points_eye,
                std::span<Eigen::Vector3f> points_base);

}  // namespace cairn::stereo
