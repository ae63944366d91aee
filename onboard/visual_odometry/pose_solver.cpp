// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/pose_solver.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "onboard/visual_odometry/landmark_view.hpp"

namespace cairn::visual_odometry {

using odometry::MotionState;
using odometry::Vector12;

namespace {

constexpr double kGate = 11.3;     // χ² of three numbers: 99 %
constexpr double kUnseen = 1e8;    // pixels², variance of a disparity that was not measured
constexpr double kWideScale = 25;  // the first steps' kernel is so many times wider, in χ²
constexpr double kSettled = 1e-4;  // m, rad: a smaller step ends the iteration
constexpr int kHypotheses = 200;
constexpr int kStepsOfThree = 6;

/// Small and the same everywhere (Steele, Lea, Flood, "SplitMix", 2014).
std::uint64_t next_random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9E3779B97F4A7C15ULL);
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

}  // namespace

/// What one match says at one pose.
struct PoseSolver::Row {
  LandmarkView view;
  Eigen::Vector3d error;   // seen − expected
  Eigen::Matrix3d weight;  // inverse covariance of the error
};

PoseSolver::PoseSolver(const VisualOdometryConfig& config, const stereo::StereoGeometry& geometry,
                       const SE3& T_base_eye)
    : config_(config), geometry_(geometry), T_base_eye_(T_base_eye), T_eye_base_(T_base_eye.inverse()) {}

bool PoseSolver::row(const Match& match, const SE3& T_base_odom, const Vector6& twist, Row& out) const {
  if (!view_landmark(geometry_, T_eye_base_, T_base_odom, match.landmark.p_odom, {twist, match.row_s}, out.view))
    return false;
  out.error = match.seen - out.view.expected;
  const double pixel = config_.pixel_noise * config_.pixel_noise;
  const double disparity = match.both_eyes ? config_.disparity_noise * config_.disparity_noise : kUnseen;
  Eigen::Matrix3d S = out.view.by_point * match.landmark.covariance * out.view.by_point.transpose();
  S.diagonal() += Eigen::Vector3d(pixel, pixel, disparity);
  if (!match.both_eyes) out.error.z() = 0;
  out.weight = S.inverse();
  return true;
}

void PoseSolver::linearise(std::span<const Match> matches, const MotionState& at, double scale, Fit& fit) const {
  const SE3 T_base_odom = at.T_odom_base.inverse();
  fit.equations = {};
  fit.uses.assign(matches.size(), {});
  fit.fits.assign(matches.size(), 0);
  fit.inliers = 0;
  double chi2 = 0, numbers = 0, squared_px = 0;
  Row r;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!row(matches[i], T_base_odom, at.twist, r)) continue;
    const double x2 = r.error.dot(r.weight * r.error);
    const double robust = 1 / (1 + x2 / (3 * scale));
    const Eigen::Matrix<double, 6, 3> JtW = robust * r.view.by_pose.transpose() * r.weight;
    fit.equations.aa += JtW * r.view.by_pose;
    fit.equations.ar -= JtW * r.error;
    fit.uses[i] = {static_cast<float>(robust * r.weight(0, 0)), matches[i].landmark.epoch};
    if (x2 > kGate * scale) continue;
    fit.fits[i] = 1;
    ++fit.inliers;
    chi2 += x2;
    numbers += matches[i].both_eyes ? 3 : 2;
    squared_px += r.error.head<2>().squaredNorm();
  }
  fit.misfit = numbers > 6 ? chi2 / (numbers - 6) : 1;
  fit.rms_px = fit.inliers > 0 ? std::sqrt(squared_px / fit.inliers) : 0;
}

Fit PoseSolver::align(std::span<const Match> matches, const odometry::MotionFilter& filter, const MotionState& start,
                      Budget& budget) const {
  Fit fit;
  fit.state = start;
  const odometry::Degeneracy none;
  double scale = kWideScale;
  while (fit.iterations < config_.max_iterations && budget.one_more()) {
    linearise(matches, fit.state, scale, fit);
    const Vector12 step =
        filter.step(fit.state, {fit.equations, none, std::max(1.0, fit.misfit) * config_.correlation_factor});
    fit.state = fit.state + step;
    ++fit.iterations;
    fit.converged = step.head<6>().norm() < kSettled && scale == 1.0;
    if (fit.converged) break;
    scale = std::max(1.0, scale / 5);
  }
  linearise(matches, fit.state, 1.0, fit);
  return fit;
}

int PoseSolver::consent(std::span<const Match> matches, const MotionState& state) const {
  const SE3 T_base_odom = state.T_odom_base.inverse();
  Row r;
  int count = 0;
  for (const Match& match : matches)
    count += row(match, T_base_odom, state.twist, r) && r.error.dot(r.weight * r.error) < 4 * kGate ? 1 : 0;
  return count;
}

/// Gauss–Newton on three matches alone: six or nine numbers, six unknowns.
bool PoseSolver::from_three(std::span<const Match> matches, const int (&chosen)[3], MotionState& state) const {
  Row r;
  for (int step = 0; step < kStepsOfThree; ++step) {
    Matrix6 H = Matrix6::Identity() * 1e-6;
    Vector6 g = Vector6::Zero();
    for (const int i : chosen) {
      if (!row(matches[static_cast<std::size_t>(i)], state.T_odom_base.inverse(), state.twist, r)) return false;
      const auto& J = r.view.by_pose;
      H += J.transpose() * r.weight * J;
      g += J.transpose() * (r.weight * r.error);
    }
    const Vector6 move = H.ldlt().solve(g);
    if (!move.allFinite() || move.head<3>().norm() > 5 || move.tail<3>().norm() > 1.5) return false;
    state.T_odom_base = state.T_odom_base * SE3::exp(move);
    if (move.norm() < kSettled) break;
  }
  return true;
}

SE3 PoseSolver::vote(std::span<const Match> matches, const MotionState& start) const {
  SE3 best = start.T_odom_base;
  int most = consent(matches, start);
  if (matches.size() < 3) return best;
  std::uint64_t random = matches.size();
  for (int h = 0; h < kHypotheses; ++h) {
    int chosen[3];
    for (int& i : chosen) i = static_cast<int>(next_random(random) % matches.size());
    if (chosen[0] == chosen[1] || chosen[1] == chosen[2] || chosen[0] == chosen[2]) continue;
    MotionState state = start;
    if (!from_three(matches, chosen, state)) continue;
    if (const int count = consent(matches, state); count > most) {
      most = count;
      best = state.T_odom_base;
    }
  }
  return best;
}

}  // namespace cairn::visual_odometry
