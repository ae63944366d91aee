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
  /// its twist went from `before` to `after` (m/s, rad/s).
  void note(const SE3& motion, double dt_s, const Vector6& before, const Vector6& after);
  /// They have contradicted each other over some scans, by so much that it shows although the robot jerks.
  [[nodiscard]] bool contradicted() const;
  /// What the twist of the scan last noted lacks, where the two have contradicted each other for seconds, be it by
  /// little. It counts as added to that twist. To be asked once after each note().
  [[nodiscard]] Vector6 lacking();
  /// The map goes on confirming the wrong twist, although for seconds scans have been added to it with the right one.
  [[nodiscard]] bool map_confirms_wrong_twist() const;
  /// The twist is made anew from the poses.
  void reset();

 private:
  // Means of: motion per second − twist. Over some scans, and over some seconds. Both begin as 0.
  Vector6 fast_ = Vector6::Zero(), slow_ = Vector6::Zero();
  double slow_weight_ = 0;           // of what was noted, in slow_
  Vector6 added_ = Vector6::Zero();  // to the last twist
  int mended_scans_ = 0;             // in a row
};

}  // namespace cairn::odometry
