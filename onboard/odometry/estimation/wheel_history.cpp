// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/wheel_history.hpp"

#include <algorithm>

namespace cairn::odometry {

void WheelHistory::add(const DriveState& state) {
  if (!states_.empty() && state.stamp <= states_.back().stamp) return;
  states_.push_back(state);
  while (states_.front().stamp < state.stamp - kKept) states_.pop_front();
}

std::optional<DriveState> WheelHistory::at(Time t) const {
  const auto after = std::ranges::upper_bound(states_, t, {}, &DriveState::stamp);
  if (after == states_.begin()) return std::nullopt;
  DriveState state = *(after - 1);
  if (t - state.stamp > kMaxAge) return std::nullopt;
  Vector6 moved = Vector6::Zero();
  moved[0] = state.v;
  moved[5] = state.w;
  const SE3 step = SE3::exp(to_seconds(t - state.stamp) * moved);
  // Errors are those of the place where the base is. Far from the start, 0.1 m between both change them by more than a
  // short way adds: the difference of two states had negative variances.
  const Matrix6 carry = step.inverse().adjoint();
  state.T_odom_base.mean = state.T_odom_base.mean * step;
  state.T_odom_base.covariance = (carry * state.T_odom_base.covariance * carry.transpose()).eval();
  state.scale_errors = (carry * state.scale_errors).eval();
  state.stamp = t;
  return state;
}

}  // namespace cairn::odometry
