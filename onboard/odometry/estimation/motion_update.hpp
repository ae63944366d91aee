// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::odometry {

/// The robot's motion, as one measurement of any sensor shows it: a scan, or a picture of both eyes.
struct MotionUpdate {
  Time stamp{};                     ///< all poses are of this instant
  UncertainPose T_odom_base;        ///< since the start, where T_odom_base was the identity
  UncertainPose T_previous_base;    ///< since the measurement before
  Vector6 twist = Vector6::Zero();  ///< of base_link in base_link: m/s, rad/s

  int iterations = 0;
  /// Directions that the surroundings do not determine. Along them the pose is the prediction, and
  /// the covariance grows.
  int degenerate_directions = 0;
  bool by_wheels = false;  ///< along those directions the wheels told the motion
  /// Metres of the way for each metre of the wheels, where the profile's scale is so wrong that they are not believed;
  /// 0: it is right, or not known.
  double wrong_wheel_scale = 0;

  bool began = false;          ///< the first one: T_odom_base is the identity, odom has nothing in common with before
  bool lost = false;           ///< the measurement did not fit: the pose is predicted, the map was left alone
  bool reinitialised = false;  ///< lost for too long: a new map began at the predicted pose
  /// Reinitialised at a pose so uncertain that the new map must not be added to the one before: they would not match.
  /// Then: a guess of where the odom before lies in the new one. One scan fits there, or it is the prediction.
  std::optional<UncertainPose> T_odom_before{};
  [[nodiscard]] bool apart() const { return T_odom_before.has_value(); }
};

}  // namespace cairn::odometry
