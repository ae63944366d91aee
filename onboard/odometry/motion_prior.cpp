// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/motion_prior.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

// A white acceleration a that is constant within a step of dt moves the body by a·dt²/√3, see
// MotionFilter::predict().
double acceleration_for(double deviation, double dt_s) { return std::sqrt(3.0) * deviation / (dt_s * dt_s); }

}  // namespace

MotionPrior::MotionPrior(const OdometryConfig& config)
    : linear_(config.linear_acceleration),
      angular_(config.angular_acceleration),
      settling_factor_(config.settling_noise_factor),
      config_(config.agility) {}

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

void MotionPrior::learn(const Vector6& change, double dt_s) {
  const Vector6 a = config_.gain / dt_s * change;
  const Eigen::Vector3d now(a.head<3>().norm(), a.segment<2>(3).norm(), std::abs(a[5]));
  const Eigen::Vector3d most(config_.most_m_s2, config_.most_rad_s2, config_.most_rad_s2);
  seen_ = (config_.decay * seen_).cwiseMax(now).cwiseMin(most);
}

}  // namespace cairn::odometry
