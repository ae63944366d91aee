// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/drift_history.hpp"

#include <algorithm>
#include <utility>

namespace cairn::odometry {
namespace {

// A new epoch begins after so much way or turn: an edge of the finest blocks, or the turn that
// moves a point at 2.5 m as far. So a block holds few epochs.
constexpr double kEpochWay_m = 0.5;
constexpr double kEpochTurn_rad = 0.2;

}  // namespace

DriftHistory::DriftHistory() : covariance_(kCapacity, Matrix6::Zero()), weight_(kCapacity, 0.0) {}

void DriftHistory::reset(const SE3& T_odom_base, const Matrix6& covariance) {
  oldest_ = newest_ = 0;
  empty_ = true;
  begun_ = T_odom_base;
  covariance_[0] = covariance;
}

void DriftHistory::advance(const SE3& T_odom_base, const Matrix6& covariance) {
  if (std::exchange(empty_, false)) return;
  const SE3 moved = begun_.inverse() * T_odom_base;
  if (newest_ > 0 && moved.translation().norm() < kEpochWay_m && rotation_angle(moved) < kEpochTurn_rad) return;
  begun_ = T_odom_base;
  ++newest_;
  oldest_ = std::max(oldest_, newest_ + 1 >= kCapacity ? newest_ + 1 - kCapacity : 0);
  covariance_[newest_ % kCapacity] = covariance;
}

Matrix6 DriftHistory::average(std::span<const KeypointUse> uses) {
  std::fill(weight_.begin(), weight_.end(), 0.0);
  double total = 0;
  for (const KeypointUse& use : uses) {
    const auto epoch = std::clamp(static_cast<std::uint64_t>(use.epoch + 0.5F), oldest_, newest_);
    weight_[epoch % kCapacity] += use.weight;
    total += use.weight;
  }
  Matrix6 sum = Matrix6::Zero();
  for (std::uint64_t e = oldest_; e <= newest_ && total > 0; ++e)
    if (weight_[e % kCapacity] > 0) sum += weight_[e % kCapacity] / total * covariance_[e % kCapacity];
  return sum;
}

}  // namespace cairn::odometry
