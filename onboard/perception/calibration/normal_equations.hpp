// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "hal/se3.hpp"

namespace cairn::calibration {

/// A change of all unknowns: shared ones, and right perturbations of the views' poses.
struct Step {
  Eigen::VectorXd shared;
  std::vector<Vector6> poses;
};

/// Normal equations of a least-squares problem whose unknowns are a few shared ones and one pose a view. A residual
/// belongs to one view, so the poses are eliminated view by view (Schur complement; Triggs et al., "Bundle Adjustment -
/// A Modern Synthesis", 2000, section 6).
class NormalEquations {
 public:
  NormalEquations(Eigen::Index shared, std::size_t views);

  /// A residual of `view` with its derivatives by the shared unknowns and by the pose, and its weight.
  void add(std::size_t view, const Eigen::RowVectorXd& shared, const Eigen::Matrix<double, 1, 6>& pose, double residual,
           double weight);
  /// The step that makes the residuals least. Diagonals are raised by the share `damping` (Marquardt). None: singular.
  [[nodiscard]] std::optional<Step> solve(double damping) const;
  /// Information about the shared unknowns when nothing is known about the poses: the Schur complement.
  [[nodiscard]] Eigen::MatrixXd information() const;

 private:
  /// The part of one view.
  struct View {
    Eigen::Matrix<double, Eigen::Dynamic, 6> cross;
    Matrix6 pose = Matrix6::Zero();
    Vector6 gradient = Vector6::Zero();
  };
  Eigen::MatrixXd shared_;
  Eigen::VectorXd gradient_;
  std::vector<View> views_;
};

/// Covariance of the shared unknowns: `variance` times the inverse of the information. Infinite variances where a
/// direction is free, which means that its variance is more than 1e12 times that of the best direction after scaling.
[[nodiscard]] Eigen::MatrixXd covariance(const Eigen::MatrixXd& information, double variance);

/// Levenberg–Marquardt. `Problem` is a value: `double cost() const` (infinite where it has no meaning),
/// `NormalEquations linearise() const`, `Problem moved(const Step&) const`. Returns whether it converged.
template <class Problem>
bool minimise(Problem& problem, int most_steps = 200) {
  double damping = 1e-3, cost = problem.cost();
  if (!(cost < std::numeric_limits<double>::infinity())) return false;
  for (int i = 0; i < most_steps; ++i) {
    const NormalEquations equations = problem.linearise();
    bool moved = false;
    while (!moved) {
      if (damping > 1e12) return true;  // no step makes it better
      if (const auto step = equations.solve(damping)) {
        Problem next = problem.moved(*step);
        const double then = next.cost();
        moved = then <= cost;
        if (moved && cost - then <= 1e-12 * cost) return true;
        if (moved) {
          problem = std::move(next);
          cost = then;
        }
      }
      damping *= moved ? 0.1 : 10;
    }
  }
  return false;
}

}  // namespace cairn::calibration
