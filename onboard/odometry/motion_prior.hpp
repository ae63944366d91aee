// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "onboard/odometry/config.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"

namespace cairn::odometry {

/// How much acceleration to expect before a scan is seen. A steady robot is believed to stay
/// steady, which makes its path straight. One that was seen to jerk is expected to do it again.
class MotionPrior {
 public:
  explicit MotionPrior(const OdometryConfig& config);

  /// At rest in odom, exactly; how fast is unknown.
  [[nodiscard]] MotionFilter::Uncertainty at_the_start() const;
  /// Of the next step. `settled`: see LocalMap::settled().
  [[nodiscard]] MotionNoise usual(bool settled) const;
  /// Of whatever a robot may have done in the last `dt_s` seconds (> 0).
  [[nodiscard]] MotionNoise anything(double dt_s) const;
  /// The filter of the last scan that was followed, `dt_s` seconds (> 0) later, expecting anything. A robot that tilts
  /// does not go on tilting. One that was `lost` since may not go on moving, either.
  [[nodiscard]] MotionFilter moved_anyhow(MotionFilter followed, double dt_s, bool lost) const;
  /// T_odom_base where a new map begins, `dt_s` seconds (> 0) after the scan of `followed`, if the filter would be
  /// `moved`. What no scan has confirmed fades: the tilt, and the climb that comes of it. So a map leans by what the
  /// robot is tilted by, and not by what it was tilted by at each new map before.
  [[nodiscard]] static SE3 levelled(const MotionFilter& moved, const MotionFilter& followed, double dt_s);
  /// The twist has changed by so much in `dt_s` seconds (> 0), as a scan showed.
  void learn(const Vector6& change, double dt_s);
  /// Forgets what was learnt.
  void reset() { seen_.setZero(); }

 private:
  double linear_, angular_, settling_factor_;
  double initial_m_s_, initial_rad_s_;
  AgilityConfig config_;
  Eigen::Vector3d seen_ = Eigen::Vector3d::Zero();  // m/s² of all axes, rad/s² of tilting, of turning
};

}  // namespace cairn::odometry
