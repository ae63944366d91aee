// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/trajectory_error.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace cairn::report {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Below this a robot counts as standing still: errors per metre would be noise divided by nothing.
constexpr double kStandingStill_m = 0.01;

SE3 interpolate(const StampedPose& a, const StampedPose& b, Time t) {
  if (b.stamp == a.stamp) return a.pose;
  const double share = to_seconds(t - a.stamp) / to_seconds(b.stamp - a.stamp);
  return {a.pose.quaternion().slerp(share, b.pose.quaternion()),
          (1 - share) * a.pose.translation() + share * b.pose.translation()};
}

std::optional<SE3> truth_at(std::span<const StampedPose> truth, Time t, Duration max_gap) {
  const auto after =
      std::lower_bound(truth.begin(), truth.end(), t, [](const StampedPose& p, Time s) { return p.stamp < s; });
  if (after == truth.end()) return std::nullopt;
  if (after->stamp == t) return after->pose;
  if (after == truth.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  if (after->stamp - before.stamp > max_gap) return std::nullopt;
  return interpolate(before, *after, t);
}

/// The rotation R that maximises tr(Rᵀ spread) (Kabsch, Umeyama). Where the positions leave it open, because the robot
/// stood still or drove along one line, it stays as near to `otherwise` as it can.
Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& spread, const SE3& otherwise) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d &U = svd.matrixU(), &V = svd.matrixV();
  const Eigen::Vector3d s = svd.singularValues();
  if (s(0) < kStandingStill_m * kStandingStill_m) return otherwise.rotation();
  if (s(1) <= 1e-9 * s(0)) {
    const Eigen::Vector3d line = otherwise.quaternion() * V.col(0);
    return (rotation_between(line, U.col(0)) * otherwise.quaternion()).toRotationMatrix();
  }
  const double mirrored = U.determinant() * V.determinant() < 0 ? -1.0 : 1.0;
  return U * Eigen::Vector3d(1, 1, mirrored).asDiagonal() * V.transpose();
}

SE3 least_squares(std::span<const MatchedPose> matched, const SE3& otherwise) {
  Eigen::Vector3d mean_truth = Eigen::Vector3d::Zero(), mean_estimate = Eigen::Vector3d::Zero();
  for (const MatchedPose& m : matched) {
    mean_truth += m.truth.translation() / static_cast<double>(matched.size());
    mean_estimate += m.estimate.translation() / static_cast<double>(matched.size());
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const MatchedPose& m : matched)
    spread += (m.truth.translation() - mean_truth) * (m.estimate.translation() - mean_estimate).transpose();
  const Eigen::Matrix3d R = best_rotation(spread, otherwise);
  return {R, mean_truth - R * mean_estimate};
}

struct AbsoluteError {
  double rmse_m = 0, max_m = 0, last_m = 0;
};

AbsoluteError absolute_error(std::span<const MatchedPose> matched, const SE3& T_truth_estimate) {
  AbsoluteError error;
  double sum = 0;
  for (const MatchedPose& m : matched) {
    error.last_m = (T_truth_estimate * m.estimate.translation() - m.truth.translation()).norm();
    error.max_m = std::max(error.max_m, error.last_m);
    sum += error.last_m * error.last_m;
  }
  error.rmse_m = std::sqrt(sum / static_cast<double>(matched.size()));
  return error;
}

/// driven[i]: metres of ground truth up to the i-th matched pose.
std::vector<double> driven_metres(std::span<const MatchedPose> matched) {
  std::vector<double> driven(matched.size(), 0.0);
  for (std::size_t i = 1; i < matched.size(); ++i)
    driven[i] = driven[i - 1] + (matched[i].truth.translation() - matched[i - 1].truth.translation()).norm();
  return driven;
}

SE3 segment_error(const MatchedPose& a, const MatchedPose& b) {
  return (a.truth.inverse() * b.truth).inverse() * (a.estimate.inverse() * b.estimate);
}

std::optional<RelativeError> segment_errors(std::span<const MatchedPose> matched, const std::vector<double>& driven) {
  if (driven.back() < kStandingStill_m) return std::nullopt;
  const double unit = std::min(100.0, driven.back() / 10);
  RelativeError mean;
  for (int k = 1; k <= 8; ++k) {
    std::size_t end = 0;
    for (std::size_t start = 0; start < matched.size(); ++start) {
      while (end < matched.size() && driven[end] < driven[start] + k * unit) ++end;
      if (end == matched.size()) break;
      const SE3 error = segment_error(matched[start], matched[end]);
      const double length = driven[end] - driven[start];
      mean.trans_percent += 100 * error.translation().norm() / length;
      mean.rot_deg_per_m += kDegrees * rotation_angle(error) / length;
      ++mean.segments;
    }
  }
  if (mean.segments == 0) return std::nullopt;
  mean.trans_percent /= static_cast<double>(mean.segments);
  mean.rot_deg_per_m /= static_cast<double>(mean.segments);
  return mean;
}

std::optional<RelativeError> step_errors(std::span<const MatchedPose> matched, double length) {
  if (length < kStandingStill_m) return std::nullopt;
  RelativeError total;
  for (std::size_t i = 1; i < matched.size(); ++i) {
    const SE3 error = segment_error(matched[i - 1], matched[i]);
    total.trans_percent += 100 * error.translation().norm() / length;
    total.rot_deg_per_m += kDegrees * rotation_angle(error) / length;
    ++total.segments;
  }
  return total;
}

}  // namespace

std::optional<Alignment> alignment_from(std::string_view name) {
  for (const Alignment a : {Alignment::kFirst, Alignment::kSe3, Alignment::kNone})
    if (name == to_string(a)) return a;
  return std::nullopt;
}

std::string_view to_string(Alignment alignment) {
  constexpr std::array<std::string_view, 3> kNames{"first", "se3", "none"};
  return kNames[static_cast<std::size_t>(alignment)];
}

std::vector<MatchedPose> match_by_time(std::span<const StampedPose> estimate, std::span<const StampedPose> truth,
                                       Duration max_gap) {
  std::vector<MatchedPose> matched;
  matched.reserve(estimate.size());
  for (const StampedPose& e : estimate)
    if (const auto t = truth_at(truth, e.stamp, max_gap)) matched.push_back({e.stamp, *t, e.pose});
  return matched;
}

SE3 align(std::span<const MatchedPose> matched, Alignment alignment) {
  if (alignment == Alignment::kNone) return {};
  const SE3 first = matched.front().truth * matched.front().estimate.inverse();
  return alignment == Alignment::kFirst ? first : least_squares(matched, first);
}

std::vector<StampedPose> truth_in_estimate_frame(std::span<const StampedPose> estimate,
                                                 std::span<const StampedPose> truth, Duration max_gap) {
  std::vector<StampedPose> moved(truth.begin(), truth.end());
  const std::vector<MatchedPose> matched = match_by_time(estimate, truth, max_gap);
  if (matched.empty()) return moved;
  const SE3 T_estimate_truth = align(matched, Alignment::kFirst).inverse();
  for (StampedPose& p : moved) p.pose = T_estimate_truth * p.pose;
  return moved;
}

Result<TrajectoryError> trajectory_error(std::span<const StampedPose> estimate, std::span<const StampedPose> truth,
                                         const TrajectoryErrorOptions& options) {
  const std::vector<MatchedPose> matched = match_by_time(estimate, truth, options.max_gap);
  if (matched.size() < 2)
    return Error{Errc::kMalformed,
                 "the trajectory and its ground truth share fewer than two moments",
                 {},
                 {},
                 std::to_string(matched.size()) + " of " + std::to_string(estimate.size()) +
                     " poses lie between two ground truth poses at most " +
                     std::to_string(to_seconds(options.max_gap)) + " s apart; are both on the same time line?"};
  const std::vector<double> driven = driven_metres(matched);
  const AbsoluteError chosen = absolute_error(matched, align(matched, options.alignment));
  const AbsoluteError first = absolute_error(matched, align(matched, Alignment::kFirst));
  TrajectoryError e;
  e.matched = matched.size();
  e.unmatched = estimate.size() - matched.size();
  e.length_m = driven.back();
  e.duration_s = to_seconds(matched.back().stamp - matched.front().stamp);
  e.ate_rmse_m = chosen.rmse_m;
  e.ate_max_m = chosen.max_m;
  e.ate_first_rmse_m = first.rmse_m;
  e.ate_se3_rmse_m = absolute_error(matched, align(matched, Alignment::kSe3)).rmse_m;
  e.final_error_m = options.alignment == Alignment::kNone ? chosen.last_m : first.last_m;
  if (e.length_m >= kStandingStill_m) e.final_error_percent = 100 * e.final_error_m / e.length_m;
  e.segments = segment_errors(matched, driven);
  e.steps = step_errors(matched, e.length_m);
  return e;
}

}  // namespace cairn::report
