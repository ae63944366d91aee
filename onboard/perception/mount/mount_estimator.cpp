// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/mount/mount_estimator.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

namespace cairn::mount {
namespace {

constexpr std::size_t kLeastSightings = 15;  // of a pair of pictures
constexpr std::size_t kLeastBlocks = 8;      // that tell how much the estimates differ
constexpr int kRounds = 3;                   // of weights
constexpr double kOutlier = 2.5;             // deviations: Cauchy's weights fall from there on
constexpr double kWeakTurn_rad = 0.05;       // what a single pair may say of the mount
constexpr double kMostInverse = 2.0;         // 1/m: nothing is nearer

/// Two residuals of one sighting, along the way that its depth moves it and square to it, in deviations.
struct Residuals {
  Eigen::Vector2d value;
  Eigen::Matrix<double, 2, 3> by;
};

struct Motion {
  SE3 T_base_camera, T_before_now;
  Eigen::Vector3d way;  // of the camera, in base_link before
};

Residuals residuals_of(const Sighting& s, const Motion& m, const EstimatorConfig& c) {
  const Eigen::Matrix3d R = m.T_base_camera.rotation(), R_motion = m.T_before_now.rotation();
  const Eigen::Vector3d u = R * s.before, v = R_motion * (R * s.now), &b = m.way;
  const auto expected = [&](double inverse_depth) { return Eigen::Vector3d(u - inverse_depth * b); };
  Eigen::Vector3d w = expected(c.inverse_depth);
  const double length = w.norm();
  w /= length;
  Eigen::Vector3d along = b - w * w.dot(b);
  const double slide = along.norm() / length;  // rad for each 1/m
  along = slide > 1e-9 ? Eigen::Vector3d(along.normalized()) : Eigen::Vector3d(w.unitOrthogonal());
  const double variance = c.sight_rad * c.sight_rad, depth_variance = std::pow(c.inverse_depth_sd * slide, 2);
  const double first = along.dot(v - w), scale = 1 / std::sqrt(variance + depth_variance);
  const double change = -first * c.inverse_depth_sd * c.inverse_depth_sd * slide * scale * scale;
  const double inverse = std::clamp(c.inverse_depth + change, 0.0, kMostInverse);
  w = expected(inverse);
  const double n = w.norm();
  w /= n;
  const Eigen::Vector3d across = w.cross(along).normalized();
  const Eigen::Matrix3d P = (Eigen::Matrix3d::Identity() - w * w.transpose()) / n;
  const Eigen::Matrix3d d = P * R * hat(s.before) - R_motion * R * hat(s.now);
  Residuals r;
  r.value << first * scale, across.dot(v - w) / c.sight_rad;
  r.by.row(0) = scale * along.transpose() * d;
  r.by.row(1) = across.transpose() * d / c.sight_rad;
  return r;
}

}  // namespace

MountEstimator::MountEstimator(const SE3& T_base_camera, const EstimatorConfig& config)
    : T_base_camera_(T_base_camera), config_(config) {}

void MountEstimator::add(Time stamp, const SE3& T_before_now, std::span<const Sighting> sightings) {
  if (sightings.size() < kLeastSightings) return;
  const Eigen::Vector3d& lever = T_base_camera_.translation();
  const Motion motion{T_base_camera_, T_before_now, T_before_now * lever - lever};
  std::vector<Residuals> all;
  all.reserve(sightings.size());
  for (const Sighting& s : sightings) all.push_back(residuals_of(s, motion, config_));
  // What one pair says of the turn tells which of its sightings do not fit.
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), gradient;
  Eigen::Matrix3d information;
  for (int round = 0; round <= kRounds; ++round) {
    information.setZero();
    gradient.setZero();
    for (const Residuals& r : all) {
      const Eigen::Vector2d left = r.value + r.by * turn;
      const double weight = 1 / (1 + left.squaredNorm() / (kOutlier * kOutlier));
      information += weight * r.by.transpose() * r.by;
      gradient += weight * r.by.transpose() * r.value;
    }
    const Eigen::Matrix3d sure = information + Eigen::Matrix3d::Identity() * std::pow(kWeakTurn_rad, -2);
    turn = -sure.ldlt().solve(gradient);
  }
  while (!blocks_.empty() && stamp - blocks_.front().begin > config_.window) blocks_.pop_front();
  if (blocks_.empty() || stamp - blocks_.back().begin >= config_.block) blocks_.push_back({.begin = stamp});
  Block& now = blocks_.back();
  ++now.pairs;
  now.information += information;
  now.gradient += gradient;
}

std::size_t MountEstimator::pairs() const {
  std::size_t sum = 0;
  for (const Block& s : blocks_) sum += s.pairs;
  return sum;
}

/// The covariance is that of the jackknife (Efron, 1982) over blocks. One block that tells most of an axis makes it
/// large.
std::optional<MountEstimator::Estimate> MountEstimator::estimate() const {
  if (blocks_.size() < kLeastBlocks) return {};
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity() * std::pow(kWeakTurn_rad, -2);
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (const Block& b : blocks_) {
    information += b.information;
    gradient += b.gradient;
  }
  Estimate e{.turn_rad = -information.ldlt().solve(gradient), .covariance = information.inverse()};
  const auto n = static_cast<double>(blocks_.size());
  for (const Block& b : blocks_) {
    const Eigen::Matrix3d others = information - b.information;
    const Eigen::Vector3d change = -others.ldlt().solve(gradient - b.gradient) - e.turn_rad;
    e.covariance += (n - 1) / n * change * change.transpose();
  }
  return e;
}

}  // namespace cairn::mount
