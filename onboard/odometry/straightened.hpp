// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/odometry/registration.hpp"

namespace cairn::odometry {

/// How a map's second scan fits if the first one was deskewed with some twist.
///
/// Both scans are skewed by their motion. Skewed alike they fit as well as deskewed ones, and by chance better. But the
/// way between them shows the motion: it belies a twist of zero.
struct Straightened {
  /// `filter`: as it predicted the second scan, `dt_s` seconds (> 0) after the first.
  [[nodiscard]] static Straightened with(const Vector6& twist, const Fit& fit, const MotionFilter& filter,
                                         double dt_s) {
    return {twist, filter.motion_to(fit.state.T_odom_base).log() / dt_s, fit, filter};
  }

  Vector6 twist;  ///< of the first scan, as assumed: m/s, rad/s
  Vector6 moved;  ///< the way to the second one, divided by its time: m/s, rad/s
  Fit fit;        ///< of the second one, with its twist
  MotionFilter filter;

  /// How much the three twists differ, m/s: as points move that are kPoints_m away.
  [[nodiscard]] double discord() const {
    const auto speed = [](const Vector6& t) { return t.head<3>().norm() + kPoints_m * t.tail<3>().norm(); };
    return speed(twist - moved) + speed(fit.state.twist - moved);
  }

  /// Whether more of the scan fits, or about as much with less discord.
  [[nodiscard]] bool likelier_than(const Straightened& other) const {
    const double here = fit.equations.inliers, there = other.fit.equations.inliers;
    return here >= kAsMuch * there && (kAsMuch * here > there || discord() < other.discord());
  }

 private:
  // Both chosen by hand. In car parks, skewed scans fitted with up to 7 % more points than straight ones.
  static constexpr double kPoints_m = 5, kAsMuch = 0.85;
};

}  // namespace cairn::odometry
