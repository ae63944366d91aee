// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "hal/se3.hpp"
#include "onboard/odometry/degeneracy.hpp"
#include "onboard/odometry/normal_equations.hpp"

namespace cairn {

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Where the base is and how it moves. Error state: T·exp(δ), twist + ν, ordered (δ, ν).
struct MotionState {
  SE3 T_odom_base;
  Vector6 twist = Vector6::Zero();  ///< of base_link in base_link: m/s, rad/s
};

[[nodiscard]] MotionState operator+(const MotionState& x, const Vector12& step);

/// White acceleration in base_link, as standard deviations.
struct MotionNoise {
  double horizontal = 3.0;  ///< m/s², along x and y
  double vertical = 1.0;    ///< m/s², along z
  double tilting = 1.0;     ///< rad/s², about x and y
  double turning = 3.0;     ///< rad/s², about z
};

/// What one scan says, linearised at one state.
struct Measurement {
  const NormalEquations& equations;
  const Degeneracy& degeneracy;  ///< `equations` are already without it
  double variance_scale;         ///< by how much the variance of independent points is too small
  double drift_scale;            ///< and by how much more for the error since the start: what is alike in many scans
};

/// An iterated extended Kalman filter with the constant-twist model. It carries two covariances of the same state:
/// `local` of the error against the map, which sets the gains, and `total` of the error against the start, which also
/// inherits the errors that the map's patches were placed with.
class MotionFilter {
 public:
  struct Uncertainty {
    Matrix12 local = Matrix12::Zero();
    Matrix12 total = Matrix12::Zero();
  };

  void reset(const MotionState& state, const Uncertainty& uncertainty);
  /// Sets the twist to zero, with this covariance and no correlation to the pose.
  void forget_twist(const Matrix6& covariance);
  /// Moves the state by `dt` seconds (> 0).
  void predict(double dt, const MotionNoise& noise);

  /// One Gauss–Newton step from `x` towards the maximum of the posterior; `m` was linearised at x.
  [[nodiscard]] Vector12 step(const MotionState& x, const Measurement& m) const;
  /// Root mean square of the pose's distance to the prediction, in its standard deviations.
  [[nodiscard]] double innovation(const MotionState& x) const;
  /// Ends the iteration at x. `map_covariance` is that of the matched patches' common displacement, as the covariance
  /// of a left perturbation of T_odom_base.
  void update(const MotionState& x, const Measurement& m, const Matrix6& map_covariance);

  [[nodiscard]] const MotionState& state() const { return state_; }
  [[nodiscard]] const Uncertainty& uncertainty() const { return uncertainty_; }
  /// Covariance of exp(δ) in T_previous_now·exp(δ) for the last predict() and update().
  [[nodiscard]] const Matrix6& step_covariance() const { return step_covariance_; }

 private:
  MotionState state_;
  Uncertainty uncertainty_;
  Matrix12 transition_ = Matrix12::Identity();  // of the last predict()
  Matrix12 process_ = Matrix12::Zero();         // its noise
  Matrix12 local_before_ = Matrix12::Zero();    // covariance before it
  Matrix6 step_covariance_ = Matrix6::Zero();
};

}  // namespace cairn
