// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/pose_error.hpp"

#include <cmath>

namespace cairn::report {
namespace {

/// The estimate that a matched pose came from: both lists run in the same order.
const PoseEstimate& estimate_at(std::span<const PoseEstimate> trajectory, std::size_t& hint, Time stamp) {
  while (trajectory[hint].stamp < stamp) ++hint;
  return trajectory[hint];
}

}  // namespace

std::vector<PoseError> pose_errors(std::span<const PoseEstimate> trajectory, std::span<const StampedPose> truth,
                                   Duration max_gap) {
  std::vector<StampedPose> means;
  means.reserve(trajectory.size());
  for (const PoseEstimate& p : trajectory) means.push_back({p.stamp, p.T_odom_base.mean});
  const std::vector<MatchedPose> matched = match_by_time(means, truth, max_gap);
  if (matched.empty()) return {};
  const SE3 T_world_odom = align(matched, Alignment::kFirst);
  std::vector<PoseError> errors;
  errors.reserve(matched.size());
  std::size_t hint = 0;
  for (const MatchedPose& m : matched) {
    const SE3 T_world_base = T_world_odom * m.estimate;
    const Matrix6& covariance = estimate_at(trajectory, hint, m.stamp).T_odom_base.covariance;
    errors.push_back({m.stamp, (T_world_base.inverse() * m.truth).log(), covariance.diagonal().cwiseMax(0).cwiseSqrt(),
                      (T_world_base.translation() - m.truth.translation()).norm()});
  }
  return errors;
}

std::array<std::optional<double>, 6> share_inside_3_sigma(std::span<const PoseError> errors) {
  std::array<std::optional<double>, 6> shares;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    double inside = 0, claimed = 0;
    for (const PoseError& e : errors) {
      if (e.sigma(axis) <= 0) continue;
      ++claimed;
      inside += std::abs(e.error(axis)) <= 3 * e.sigma(axis) ? 1 : 0;
    }
    if (claimed > 0) shares[static_cast<std::size_t>(axis)] = inside / claimed;
  }
  return shares;
}

}  // namespace cairn::report
