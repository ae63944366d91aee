// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/relocaliser.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

// Times min_matches. A scan of fewer keypoints does not tell where the robot is.
constexpr std::size_t kTellingMatches = 4;
// Of the position's standard deviation: farther than this the robot cannot have come.
constexpr double kFarthestSigmas = 3.0;

}  // namespace

std::string_view to_string(Relocalisation answer) {
  switch (answer) {
    case Relocalisation::kNotNeeded:
      return "not needed";
    case Relocalisation::kUndecided:
      return "undecided";
    case Relocalisation::kFound:
      return "found";
    case Relocalisation::kElsewhere:
      return "elsewhere";
  }
  return "unknown";
}

Relocaliser::Relocaliser(const OdometryConfig& config) : config_(config.restart), min_matches_(config.min_matches) {}

MotionFilter::Uncertainty Relocaliser::expect(const UncertainPose& T_odom_base, const Vector6& twist) {
  Vector12 sigma;
  sigma << config_.position_m + config_.braking_s * twist.head<3>().cwiseAbs().array(),
      config_.angle_rad + config_.braking_s * twist.tail<3>().cwiseAbs().array(),
      Eigen::Vector3d::Constant(config_.speed_m_s), Eigen::Vector3d::Constant(config_.turn_rad_s);
  MotionFilter::Uncertainty uncertainty;
  uncertainty.local = sigma.cwiseAbs2().asDiagonal();
  uncertainty.total = uncertainty.local;
  uncertainty.total.topLeftCorner<6, 6>() += T_odom_base.covariance;
  expected_ = {.T_odom_base = T_odom_base.mean,
               .farthest_m = kFarthestSigmas * std::sqrt(uncertainty.local.topLeftCorner<3, 3>().trace()),
               .known_share = 0};
  return uncertainty;
}

void Relocaliser::compare_with(double known_share) {
  if (expected_) expected_->known_share = known_share;
}

double Relocaliser::moving_time_s(double dt_s) const { return expected_ ? std::min(dt_s, config_.coasting_s) : dt_s; }

Relocalisation Relocaliser::judge(const Fit& fit, std::size_t keypoints) {
  if (!expected_) return Relocalisation::kNotNeeded;
  if (keypoints <= kTellingMatches * static_cast<std::size_t>(min_matches_)) return Relocalisation::kUndecided;
  const bool found = fits(fit, keypoints);
  expected_.reset();
  return found ? Relocalisation::kFound : Relocalisation::kElsewhere;
}

bool Relocaliser::fits(const Fit& fit, std::size_t keypoints) const {
  const SE3 motion = expected_->T_odom_base.inverse() * fit.state.T_odom_base;
  const double enough = config_.found_share * expected_->known_share * static_cast<double>(keypoints);
  return fit.equations.matched >= min_matches_ && fit.equations.inliers >= enough &&
         motion.translation().norm() <= expected_->farthest_m;
}

}  // namespace cairn::odometry
