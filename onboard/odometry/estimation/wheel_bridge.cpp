// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/wheel_bridge.hpp"

#include <Eigen/Cholesky>
#include <array>

namespace cairn::odometry {
namespace {

// Wheels slip more than their model says, and their stamps are off by some milliseconds. Height and tilt come from the
// ground. All chosen by hand.
constexpr double kDistrust = 2.0;
constexpr double kLeast_m = 0.05, kLeastHeight_m = 0.1, kLeastTilt_rad = 0.05, kLeastYaw_rad = 0.03;

// The same where scans follow each other: most errors of stamps cancel from one scan to the next.
constexpr double kStamps_m = 0.005, kStamps_rad = 0.01;

// 99.9 % of chi² with three degrees of freedom.
constexpr double kExcluded = 16.3;

/// Of twist(), m/s and rad/s. Chosen by hand.
Vector6 twist_deviation() { return (Vector6() << 0.3, 0.2, 0.1, 0.3, 0.3, 0.3).finished(); }

Matrix6 deviations(double along_m, double about_rad) {
  Vector6 deviation;
  deviation << Eigen::Vector3d::Constant(along_m), Eigen::Vector3d::Constant(about_rad);
  return deviation.cwiseAbs2().asDiagonal();
}

Matrix6 least() {
  Vector6 deviation;
  deviation << kLeast_m, kLeast_m, kLeastHeight_m, kLeastTilt_rad, kLeastTilt_rad, kLeastYaw_rad;
  return deviation.cwiseAbs2().asDiagonal();
}

/// Without what is wrong in the same way at all times.
Matrix6 noise_of(const DriveState& wheels) {
  return wheels.T_odom_base.covariance - wheels.scale_errors * wheels.scale_errors.transpose();
}

}  // namespace

void WheelBridge::note(const DriveState* wheels) { now_ = wheels != nullptr ? std::optional(*wheels) : std::nullopt; }

void WheelBridge::followed() { followed_ = now_; }

/// Both states are there.
UncertainPose WheelBridge::difference() const {
  const SE3 motion = followed_->T_odom_base.mean.inverse() * now_->T_odom_base.mean;
  const Matrix6 carry = motion.inverse().adjoint();
  // Dead reckoning adds the motion's own noise to the old one, carried along. The scales are wrong in both alike.
  const Matrix6 noise = noise_of(*now_) - carry * noise_of(*followed_) * carry.transpose();
  const auto scales = (now_->scale_errors - carry * followed_->scale_errors).eval();
  return {.mean = motion, .covariance = kDistrust * kDistrust * (noise + scales * scales.transpose())};
}

std::optional<UncertainPose> WheelBridge::measured() const {
  if (!now_ || !followed_ || now_->slipping) return std::nullopt;
  UncertainPose motion = difference();
  motion.covariance += deviations(kStamps_m, kStamps_rad);
  return motion;
}

std::optional<UncertainPose> WheelBridge::since_followed() const {
  if (!now_ || !followed_) return std::nullopt;
  UncertainPose motion = difference();
  motion.covariance += least();
  return motion;
}

/// Not by height and tilt: wheels do not measure them, and ground rises.
bool WheelBridge::allow(const SE3& motion) const {
  static const std::array kPlanar{0, 1, 5};  // x, y, heading
  const UncertainPose told = *since_followed();
  const Eigen::Vector3d off = (told.mean.inverse() * motion).log()(kPlanar);
  const Eigen::Matrix3d P = told.covariance(kPlanar, kPlanar);
  return off.dot(P.ldlt().solve(off)) <= kExcluded;
}

MotionFilter WheelBridge::move(MotionFilter followed, double dt_s) const {
  followed.predict_by(*since_followed(), twist(), twist_deviation(), dt_s);
  return followed;
}

Vector6 WheelBridge::twist() const {
  Vector6 twist = Vector6::Zero();
  if (now_) twist << now_->v, 0, 0, 0, 0, now_->w;
  return twist;
}

}  // namespace cairn::odometry
