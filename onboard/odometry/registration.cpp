// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/registration.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

// The gate begins at 3 standard deviations of the predicted position, and halves with every step.
constexpr double kGateSigmas = 3.0, kGateShrink = 0.5;
// m. An error in rotation moves a point at this range by as much as the first gate allows for it.
// Found with walks through simulated buildings, whose tilt changes by 6° in a scan.
constexpr double kLever_m = 5;
// Keypoints: fewer say nothing about how well a scan fits. As OdometryConfig::min_matches.
constexpr int kFewTelling = 60;
// Converged: the step is below a fiftieth of noise_floor_m (0.01 m); its rotation moves a point at
// 10 m as far.
constexpr double kConverged_m = 2e-4, kConverged_rad = 2e-5;

bool is_small(const Vector12& step) {
  return step.head<3>().norm() < kConverged_m && step.segment<3>(3).norm() < kConverged_rad;
}

}  // namespace

double Fit::inlier_ratio() const {
  return equations.matched > 0 ? static_cast<double>(equations.inliers) / equations.matched : 0.0;
}

int Fit::telling_inliers() const {
  return equations.telling < kFewTelling ? equations.inliers : equations.telling_inliers;
}

double Fit::telling_share() const {
  if (equations.telling < kFewTelling) return inlier_ratio();
  return static_cast<double>(equations.telling_inliers) / equations.telling;
}

double Fit::level_share() const {
  if (equations.matched == 0) return 0.0;
  return static_cast<double>(equations.inliers - equations.telling_inliers) / equations.matched;
}

double Fit::rms_m() const {
  return equations.robust > 0 ? std::sqrt(equations.squared_distance / equations.robust) : 0.0;
}

double Fit::misfit() const { return equations.robust > 0 ? equations.chi2 / equations.robust : 1.0; }

Registration::Registration(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers)
    : T_base_lidar_(T_base_lidar),
      workers_(workers),
      max_iterations_(config.max_iterations),
      narrowest_gate_m_(config.narrowest_gate_m),
      widest_gate_m_(config.widest_gate_m),
      min_facing_points_(config.min_facing_points),
      correlation_factor_(config.correlation_factor),
      fresh_share_(config.fresh_share),
      linearise_(static_cast<std::size_t>(2 * config.keypoints)) {}

Fit Registration::align(const Selection& scan, const PatchMap& map, const MotionFilter& filter,
                        const MotionState& start, Budget& budget) {
  return align(scan, map, filter, start, budget, effort_for(filter));
}

Registration::Effort Registration::effort_for(const MotionFilter& filter) {
  const Matrix12& P = filter.uncertainty().local;
  const double squared_m2 = P.topLeftCorner<3, 3>().trace() + kLever_m * kLever_m * P.block<3, 3>(3, 3).trace();
  return {kGateSigmas * std::sqrt(squared_m2)};
}

Fit Registration::align(const Selection& scan, const PatchMap& map, const MotionFilter& filter,
                        const MotionState& start, Budget& budget, const Effort& effort) {
  Fit fit;
  fit.state = start;
  const int max_steps = std::min(max_iterations_, effort.max_steps);
  double gate_m = std::clamp(effort.gate_m, narrowest_gate_m_, widest_gate_m_);
  Vector12 last = Vector12::Zero();
  while (!fit.converged && fit.iterations < max_steps && budget.one_more()) {
    const Vector12 step =
        iterate(fit, linearise(scan, map, fit.state, gate_m), filter, effort.share * min_facing_points_);
    // A step that undoes the last one would be undone in turn: a few points change between two patches for ever.
    fit.converged = gate_m <= narrowest_gate_m_ && (is_small(step) || is_small(last + step));
    last = step;
    gate_m = std::max(narrowest_gate_m_, kGateShrink * gate_m);
  }
  return fit;
}

Vector12 Registration::iterate(Fit& fit, const NormalEquations& all, const MotionFilter& filter,
                               double min_facing_points) const {
  fit.degeneracy = find_degeneracy(all, linearise_.rows(), min_facing_points);
  fit.equations = without_degenerate(all, fit.degeneracy);
  const Vector12 step = filter.step(fit.state, {fit.equations, fit.degeneracy, correlation_factor_});
  fit.state = fit.state + step;
  ++fit.iterations;
  return step;
}

int Registration::inliers(const Selection& scan, const PatchMap& map, const MotionState& at, double gate_m) {
  return linearise(scan, map, at, gate_m).inliers;
}

int Registration::telling_inliers(const Selection& scan, const PatchMap& map, const MotionState& at, double gate_m) {
  return linearise(scan, map, at, gate_m).telling_inliers;
}

double Registration::weight(const Selection& scan, const PatchMap& map, const MotionState& at, double gate_m) {
  return linearise(scan, map, at, gate_m).robust;
}

NormalEquations Registration::linearise(const Selection& scan, const PatchMap& map, const MotionState& at,
                                        double gate_m) {
  const Linearisation here{.T_odom_base = at.T_odom_base,
                           .twist = at.twist,
                           .T_base_lidar = T_base_lidar_,
                           .duration_s = scan.duration_s,
                           .gate_m = gate_m,
                           .fresh_share = fresh_share_};
  return linearise_(scan.keypoints, map, here, workers_);
}

}  // namespace cairn::odometry
