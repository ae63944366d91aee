// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/motion_prior.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

// A white acceleration a that is constant within a step of dt moves the body by a·dt²/√3, see
// MotionFilter::predict().
double acceleration_for(double deviation, double dt_s) { return std::sqrt(3.0) * deviation / (dt_s * dt_s); }

// s. A twist that no scan has confirmed is believed for so long, on average: a robot that was lost
// while it turned has often ended the turn.
constexpr double kTwistBelieved_s = 0.2;

// s. Tilt and climb are believed for so long, on average. Chosen by hand: where a silence of second_look.blind_after_s
// ends, a third is left.
constexpr double kTiltBelieved_s = 3;

/// Of a steady motion over `dt_s` seconds, the share that is left when belief in it fades.
double believed_share(double dt_s, double believed_s) { return believed_s / dt_s * (1 - std::exp(-dt_s / believed_s)); }

}  // namespace

MotionPrior::MotionPrior(const OdometryConfig& config)
    : linear_(config.linear_acceleration),
      angular_(config.angular_acceleration),
      settling_factor_(config.settling_noise_factor),
      initial_m_s_(config.initial_speed),
      initial_rad_s_(config.initial_angular_speed),
      config_(config.agility) {}

MotionFilter::Uncertainty MotionPrior::at_the_start() const {
  Vector6 speed;
  speed << Eigen::Vector3d::Constant(initial_m_s_), Eigen::Vector3d::Constant(initial_rad_s_);
  MotionFilter::Uncertainty uncertainty;
  uncertainty.local.bottomRightCorner<6, 6>() = speed.cwiseAbs2().asDiagonal();
  uncertainty.total = uncertainty.local;
  return uncertainty;
}

MotionNoise MotionPrior::usual(bool settled) const {
  const double factor = settled ? 1.0 : settling_factor_;
  const double tilting = std::max(factor * angular_, seen_[1]);
  MotionNoise noise;
  noise.acceleration << Eigen::Vector3d::Constant(std::max(factor * linear_, seen_[0])), tilting, tilting,
      std::max(factor * angular_, seen_[2]);
  return noise;
}

MotionNoise MotionPrior::anything(double dt_s) const {
  const double moved = acceleration_for(config_.any_way_m + config_.any_speed_m_s * dt_s, dt_s);
  const double tilted = acceleration_for(config_.any_tilt_rad, dt_s);
  const double turned = acceleration_for(config_.any_heading_rad + config_.any_turn_rad_s * dt_s, dt_s);
  MotionNoise noise;
  noise.acceleration << Eigen::Vector3d::Constant(moved), tilted, tilted, turned;
  return noise;
}

MotionFilter MotionPrior::moved_anyhow(MotionFilter followed, double dt_s, bool lost) const {
  Vector6 kept = Vector6::Constant(lost ? believed_share(dt_s, kTwistBelieved_s) : 1.0);
  kept.segment<2>(3).setZero();
  followed.doubt_twist(kept);
  followed.predict(dt_s, anything(dt_s));
  return followed;
}

SE3 MotionPrior::levelled(const MotionFilter& moved, const MotionFilter& followed, double dt_s) {
  const SE3& T_odom_base = moved.state().T_odom_base;
  const Eigen::Vector3d up = T_odom_base.rotation().col(2);
  const double kept = std::exp(-dt_s / kTiltBelieved_s);
  const Eigen::Vector3d level = kept * up + (1 - kept) * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d p = T_odom_base.translation();
  p.z() = std::lerp(followed.state().T_odom_base.translation().z(), p.z(), believed_share(dt_s, kTiltBelieved_s));
  return {rotation_between(up, level) * T_odom_base.quaternion(), p};
}

void MotionPrior::learn(const Vector6& change, double dt_s) {
  const Vector6 a = config_.gain / dt_s * change;
  const Eigen::Vector3d now(a.head<3>().norm(), a.segment<2>(3).norm(), std::abs(a[5]));
  const Eigen::Vector3d most(config_.most_m_s2, config_.most_rad_s2, config_.most_rad_s2);
  seen_ = (config_.decay * seen_).cwiseMax(now).cwiseMin(most);
}

}  // namespace cairn::odometry
