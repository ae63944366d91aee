// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/wheel_aid.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

// A turn of the wheels differs from the base's by so much without slip: skid steering drags all four wheels sideways.
// Chosen by hand.
constexpr double kSkid_rad = 0.02, kSkidShare = 0.5;

// Only straight pieces of the way tell the scale, and only where both have moved. Errors of stamps count as metres.
constexpr double kStraight_rad = 0.02, kMoved_m = 0.03, kMeasured_m = 0.01;
// The scale wanders by a tenth of a percent in 100 steps: tyres grow warm.
constexpr double kWander = 1e-4;
constexpr double kMostDeviations = 3;
// The least distance that counts as another place: below half of a search's step of 0.25 m. Chosen by hand.
constexpr double kAgree_m = 0.1;
// So far all steps have to differ before they are no slip. Chosen by hand.
constexpr double kAlike_m = 5;
constexpr double kLeastScale = 0.8, kMostScale = 1.25;

}  // namespace

std::optional<OpenMotion> WheelAid::along(const Matrix6& directions, const WheelBridge& wheels) const {
  if (directions.isZero() || watch_.wrong()) return std::nullopt;
  const auto measured = wheels.measured();
  if (!measured) return std::nullopt;
  Vector6 motion = measured->mean.log();
  const double forward_m = motion[0];
  motion.head<3>() *= scale_;
  OpenMotion open{.directions = directions, .motion = motion, .covariance = measured->covariance};
  // A wrong scale is the same error all the way: its deviation grows with the way, not with the root of it.
  const double way_m = open_way_m_ + std::abs(forward_m);
  open.covariance(0, 0) += scale_variance_ * (way_m * way_m - open_way_m_ * open_way_m_);
  return open;
}

bool WheelAid::slipped(const WheelBridge& wheels, const SE3& motion) {
  const auto measured = wheels.measured();
  if (!measured) return false;
  const double wheels_rad = measured->mean.log()[5], base_rad = motion.log()[5];
  return std::abs(wheels_rad - base_rad) > kSkid_rad + kSkidShare * std::abs(wheels_rad);
}

std::optional<OpenMotion> WheelAid::possible_motion(const Vector6& twist, const MotionNoise& anything,
                                                    double dt_s) const {
  if (open_.isZero()) return std::nullopt;
  const Vector6 deviation =
      anything.acceleration * (dt_s * dt_s / std::sqrt(3.0));  // as MotionFilter::predict() has it
  return OpenMotion{
      .directions = open_, .motion = dt_s * twist, .covariance = deviation.cwiseAbs2().asDiagonal().toDenseMatrix()};
}

bool WheelAid::agrees(const OpenMotion& open, const SE3& motion) {
  const Vector6 difference = open.directions * (motion.log() - open.motion);
  const Matrix6 P = open.directions * open.covariance * open.directions.transpose();
  return difference.head<3>().norm() < kMostDeviations * std::sqrt(P.topLeftCorner<3, 3>().trace()) + kAgree_m;
}

void WheelAid::followed(const WheelBridge& wheels, const SE3& motion, const Degeneracy& degeneracy) {
  open_ = degeneracy.undetermined;
  open_way_m_ = degeneracy.count > 0 ? open_way_m_ + std::abs(motion.log()[0]) : 0;
  const auto measured = wheels.measured();
  if (degeneracy.count > 0 || !measured || slipped(wheels, motion)) return;
  const Vector6 by_wheels = measured->mean.log(), by_scan = motion.log();
  if (std::abs(by_scan[5]) >= kStraight_rad) return;
  if (std::abs(by_wheels[0]) > kMoved_m || std::abs(by_scan[0]) > kMoved_m) watch_.add(by_wheels[0], by_scan[0]);
  if (std::abs(by_wheels[0]) > kMoved_m) learn_scale(by_wheels[0], by_scan[0]);
}

/// A Kalman filter of one number.
void WheelAid::learn_scale(double wheels_m, double base_m) {
  scale_variance_ = std::min(scale_variance_ + kWander * kWander, kFirstScale * kFirstScale);
  const double innovation = base_m - scale_ * wheels_m;
  const double variance = wheels_m * wheels_m * scale_variance_ + kMeasured_m * kMeasured_m;
  if (innovation * innovation > kMostDeviations * kMostDeviations * variance) return learn_anew(base_m);
  refused_m_ = 0;
  const double gain = wheels_m * scale_variance_ / variance;
  scale_ = std::clamp(scale_ + gain * innovation, kLeastScale, kMostScale);
  scale_variance_ *= 1 - gain * wheels_m;
}

/// Steps that all differ alike are no slip: the filter began too far from the truth.
void WheelAid::learn_anew(double base_m) {
  refused_m_ += std::abs(base_m);
  const auto scale = watch_.scale();
  if (!scale || watch_.wrong() || refused_m_ < kAlike_m) return;
  const double difference = *scale - scale_;
  if (difference * difference < kMostDeviations * kMostDeviations * scale_variance_) return;
  scale_ = *scale;
  scale_variance_ = kFirstScale * kFirstScale;
}

}  // namespace cairn::odometry
