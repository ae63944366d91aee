// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hal/drive.hpp"
#include "hal/se3.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"

namespace cairn::odometry {

/// What the wheels say of the motion since the last scan that was followed. It stands in where scans do not tell: over
/// a gap, and while the robot is lost.
class WheelBridge {
 public:
  /// The wheels' state at the scan that comes now, or null where there is none.
  void note(const DriveState* wheels);
  /// The scan that came last was followed.
  void followed();
  /// Nothing connects to what comes next.
  void forget() { followed_.reset(); }

  /// Motion of the base since the last followed scan, as the wheels measure it. None without wheels, now or then, and
  /// where they contradict each other.
  [[nodiscard]] std::optional<UncertainPose> measured() const;
  /// Motion of the base since the last followed scan, with the wheels' covariance (of a right perturbation), widened by
  /// what wheels do not measure. None without wheels, now or then.
  [[nodiscard]] std::optional<UncertainPose> since_followed() const;
  /// Whether the base can have moved so since the last followed scan: way and heading are within what since_followed(),
  /// which is there, makes likely.
  [[nodiscard]] bool allow(const SE3& motion) const;
  /// The filter of that scan, moved on by since_followed(), which is there. `dt_s`: seconds since that scan, above 0.
  [[nodiscard]] MotionFilter move(MotionFilter followed, double dt_s) const;
  /// Of base_link in base_link, m/s and rad/s. Valid where since_followed() is.
  [[nodiscard]] Vector6 twist() const;

 private:
  [[nodiscard]] UncertainPose difference() const;

  std::optional<DriveState> now_, followed_;
};

}  // namespace cairn::odometry
