// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/se3.hpp"

namespace cairn::odometry {

/// Finds out that poses and twist contradict each other. A wrong twist deskews all scans alike, and
/// a map of such scans confirms it. The poses are right nevertheless: one can turn by 1° in each
/// scan, with a twist of 80°/s. No robot moves like that for long.
class TwistCheck {
 public:
  /// Takes note of a scan that was followed: the base made `motion` in `dt_s` seconds (> 0), while
  /// its twist went from `before` to `after` (m/s, rad/s). True if they have contradicted each
  /// other over some scans.
  [[nodiscard]] bool contradicts(const SE3& motion, double dt_s, const Vector6& before, const Vector6& after);
  /// The twist is made anew from the poses.
  void reset() { difference_.setZero(); }

 private:
  Vector6 difference_ = Vector6::Zero();  // mean over some scans of: motion per second − twist
};

}  // namespace cairn::odometry
