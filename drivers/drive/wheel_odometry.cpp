// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/wheel_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace cairn::drive {
namespace {

constexpr double square(double x) { return x * x; }

}  // namespace

std::optional<std::int32_t> WheelCounter::update(std::int32_t count) {
  const auto before = std::exchange(last_, count);
  if (!before) return std::nullopt;
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(count) - static_cast<std::uint32_t>(*before));
}

WheelOdometry::WheelOdometry(const Config& config) : config_(config) {
  if (!(config.wheel_separation_m > 0)) std::abort();
  covariance_(6, 6) = square(config.travel_scale);
  covariance_(7, 7) = square(config.rotation_scale);
}

const DriveState& WheelOdometry::start(Time stamp) {
  state_.stamp = stamp;
  state_.T_odom_base.covariance = kFloor * Matrix6::Identity();
  return state_;
}

double WheelOdometry::reach(Duration dt) const {
  const double rim = config_.max_speed_m_s + config_.max_yaw_rate_rad_s * config_.wheel_separation_m / 2;
  return 1.5 * rim * to_seconds(dt) + 0.02;  // stamps may be some milliseconds off
}

double WheelOdometry::variance(double travel) const { return square(config_.travel_noise_m) * std::abs(travel); }

const DriveState& WheelOdometry::update(const Travel& travel) {
  const Duration dt = travel.stamp - state_.stamp;
  if (dt <= Duration::zero()) return state_;
  if (std::max(std::abs(travel.left), std::abs(travel.right)) > reach(dt)) return bridge(travel.stamp);
  watch_for_slip(travel, to_seconds(dt));
  const auto doubt = [&](double d) {
    return variance(d) +
           (state_.slipping ? square(config_.slip_factor) * std::abs(d) * std::max(std::abs(d), kSlipLength) : 0);
  };
  move(travel, doubt(travel.left), doubt(travel.right), dt);
  return state_;
}

const DriveState& WheelOdometry::bridge(Time stamp) {
  const Duration dt = stamp - state_.stamp;
  if (dt <= Duration::zero()) return state_;
  const double seconds = to_seconds(dt), half = state_.w * config_.wheel_separation_m / 2;
  const Travel guess{stamp, (state_.v - half) * seconds, (state_.v + half) * seconds, 0, 0};
  const double doubt = square(reach(dt) / 2);
  state_.slipping = true;
  window_ = 0;
  window_before_ = false;
  left_ = right_ = {};
  move(guess, doubt, doubt, dt);
  return state_;
}

/// Speeds are compared over a window, because a reading's arrival jitters by more than a short interval bears.
void WheelOdometry::watch_for_slip(const Travel& travel, double dt) {
  left_.travel += travel.left;
  right_.travel += travel.right;
  window_ += dt;
  window_disagreement_ += travel.disagreement;
  window_resolution_ = std::max(window_resolution_, travel.resolution);
  if (window_ < to_seconds(kSlipWindow)) return;
  const double steps = 2 * window_resolution_;
  const auto slips = [&](Side& side) {
    const double speed = side.travel / window_;
    const double change = std::abs(speed - std::exchange(side.speed, speed));
    const bool torn = window_before_ && change > config_.traction_m_s2 * window_ + steps / window_;
    const bool apart = window_disagreement_ > 0.1 * std::abs(side.travel) + steps;
    side.travel = 0;
    return torn || apart;
  };
  const bool left = slips(left_), right = slips(right_);
  state_.slipping = left || right;
  window_before_ = true;
  window_ = window_disagreement_ = 0;
}

void WheelOdometry::move(const Travel& t, double left_variance, double right_variance, Duration dt) {
  const double b = config_.wheel_separation_m, way = (std::abs(t.left) + std::abs(t.right)) / 2;
  const double s = (t.left + t.right) / 2, theta = (t.right - t.left) / b;
  Vector6 delta = Vector6::Zero();
  delta[0] = s;
  delta[5] = theta;
  const SE3 step = SE3::exp(delta);
  const Matrix6 J = right_jacobian(delta);
  Matrix6 noise = Matrix6::Zero();
  noise(0, 0) = (left_variance + right_variance) / 4;
  noise(5, 5) = (left_variance + right_variance) / square(b);
  noise(0, 5) = noise(5, 0) = (right_variance - left_variance) / (2 * b);
  noise(1, 1) = square(config_.lateral_slip) * std::abs(t.right - t.left) * b + (state_.slipping ? noise(0, 0) : 0);
  noise(2, 2) = square(config_.ground_noise_m) * way;
  noise(3, 3) = noise(4, 4) = square(config_.ground_noise_rad) * way;

  Matrix8 F = Matrix8::Identity();
  F.topLeftCorner<6, 6>() = step.inverse().adjoint();
  F.block<6, 1>(0, 6) = J.col(0) * s;
  F.block<6, 1>(0, 7) = J.col(5) * theta;
  covariance_ = (F * covariance_ * F.transpose()).eval();
  covariance_.topLeftCorner<6, 6>() += J * noise * J.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();

  state_.stamp = t.stamp;
  state_.T_odom_base.mean = state_.T_odom_base.mean * step;
  state_.T_odom_base.covariance = covariance_.topLeftCorner<6, 6>() + kFloor * Matrix6::Identity();
  state_.scale_errors = covariance_.topRightCorner<6, 2>();
  for (const int i : {0, 1}) {
    if (const double variance = covariance_(6 + i, 6 + i); variance > 0)
      state_.scale_errors.col(i) /= std::sqrt(variance);
  }
  set_twist(s, theta, noise(0, 0) + square(t.resolution), noise(5, 5) + 2 * square(t.resolution / b), to_seconds(dt));
}

void WheelOdometry::set_twist(double s, double theta, double var_s, double var_theta, double dt) {
  state_.v = s / dt;
  state_.w = theta / dt;
  state_.twist_covariance(0, 0) = var_s / square(dt) + square(config_.travel_scale * state_.v) + kFloor;
  state_.twist_covariance(1, 1) = var_theta / square(dt) + square(config_.rotation_scale * state_.w) + kFloor;
}

}  // namespace cairn::drive
