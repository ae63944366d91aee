// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "hal/se3.hpp"
#include "onboard/odometry/estimation/degeneracy.hpp"
#include "onboard/odometry/estimation/normal_equations.hpp"

namespace cairn::odometry {

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Matrix12x6 = Eigen::Matrix<double, 12, 6>;

/// Where the base is and how it moves. Error state: T·exp(δ), twist + ν, ordered (δ, ν).
struct MotionState {
  SE3 T_odom_base;
  Vector6 twist = Vector6::Zero();  ///< of base_link in base_link: m/s, rad/s
};

/// White acceleration, constant within one step: standard deviations along the body's axes (m/s²,
/// rad/s²).
struct MotionNoise {
  Vector6 acceleration = Vector6::Zero();

  [[nodiscard]] static MotionNoise of(double linear, double angular) {
    return {(Vector6() << Eigen::Vector3d::Constant(linear), Eigen::Vector3d::Constant(angular)).finished()};
  }
};

/// A motion along the directions that a scan has left open, as something else has measured it.
struct OpenMotion {
  Matrix6 directions;  ///< takes a right perturbation to its part along them; see Degeneracy::undetermined
  Vector6 motion;      ///< since the scan, as a tangent vector: m, rad; only the part along `directions` counts
  Matrix6 covariance;  ///< of `motion`
};

/// What one scan says, linearised at one state.
struct Measurement {
  const NormalEquations& equations;
  const Degeneracy& degeneracy;  ///< `equations` are already without it
  /// By how much the equations' weights are too large: squared misfit of single points times points
  /// per independent piece of information. Gains and covariance both follow from it. So a direction
  /// that few or wrong points determine does not outvote the prediction.
  double overconfidence;
};

/// An iterated extended Kalman filter with the constant-twist model. It carries two covariances of
/// the same state: `local` of the error against the map, which sets the gains, and `total` of the
/// error against the start, which also inherits the errors that the map's planes were placed with.
///
/// A twist that is wrong all the time deskews all scans alike, and a map of such scans confirms it.
/// But the poses do not move like it. Their errors are not carried from scan to scan. So the mean
/// gap between motion and twist over some scans is the twist's common error, whatever the
/// acceleration. Predictions correct it slowly.
class MotionFilter {
 public:
  /// Covariances of pose and twist: `local` against the map, `total` against the start.
  struct Uncertainty {
    Matrix12 local = Matrix12::Zero();
    Matrix12 total = Matrix12::Zero();
  };

  void reset(const MotionState& state, const Uncertainty& uncertainty);
  /// Forgets how far motion and twist have differed: the next scans begin a new map.
  void forget_gap();
  /// Keeps this share of each component of the twist, 0…1: nothing has confirmed it. Its uncertainty grows by what
  /// was taken.
  void doubt_twist(const Vector6& share);
  /// Moves the state by `dt` seconds (> 0).
  /// Where `open` is not null, the measured motion stands in for the twist along the open directions.
  void predict(double dt, const MotionNoise& noise, const OpenMotion* open = nullptr);

  /// The same by a motion that something else has measured, and a twist with these standard deviations (m/s, rad/s).
  void predict_by(const UncertainPose& motion, const Vector6& twist, const Vector6& deviation, double dt);

  /// Takes `state` instead, with the uncertainty as it is: what a search has found, or an adjustment.
  void believe(const MotionState& state) { state_ = state; }
  void believe(const SE3& T_odom_base) { state_.T_odom_base = T_odom_base; }

  /// Adds what poses show that the twist lacks. The gap is closed then.
  void mend_twist(const Vector6& lacking) {
    state_.twist += lacking;
    forget_gap();
  }

  /// One Gauss–Newton step from `x` towards the maximum of the posterior; `n` was linearised at x.
  [[nodiscard]] Vector12 step(const MotionState& x, const Measurement& m) const;
  /// Ends the iteration at x. `map_covariance` is that of the matched planes' common displacement,
  /// as the covariance of a left perturbation of T_odom_base.
  void update(const MotionState& x, const Measurement& m, const Matrix6& map_covariance);
  /// After an update: notes how far the motion since the last predict() differs from the twist. The next predict()
  /// corrects the twist by a share of it. The pose's error, divided by the time of the motion, is part of it.
  void follow_motion();

  [[nodiscard]] const MotionState& state() const { return state_; }
  [[nodiscard]] const Uncertainty& uncertainty() const { return uncertainty_; }
  /// T_odom_base with the covariance of its error against the start.
  [[nodiscard]] UncertainPose pose() const;
  /// The same covariance, of a left perturbation of T_odom_base.
  [[nodiscard]] Matrix6 odom_covariance() const;
  /// Whether position and heading against the map have no larger standard deviations than these: m, rad.
  [[nodiscard]] bool placed_within(double position_m, double heading_rad) const;
  /// If another odom begins at the present state: where this one lies in it. The base is about where the state says; it
  /// was `found` there by a scan that fits, or was predicted.
  [[nodiscard]] UncertainPose place_of_odom(bool found) const;
  /// Motion to T_odom_base from where the base was before the last predict().
  [[nodiscard]] SE3 motion_to(const SE3& T_odom_base) const { return before_.T_odom_base.inverse() * T_odom_base; }
  /// By how much this pose is off the state, in standard deviations of the local uncertainty, squared: chi² with six
  /// degrees of freedom.
  [[nodiscard]] double squared_surprise(const SE3& T_odom_base) const;
  /// Covariance of exp(δ) in T_previous_now·exp(δ) for the last predict() and update().
  [[nodiscard]] const Matrix6& step_covariance() const { return step_covariance_; }

 private:
  [[nodiscard]] Vector6 expect(double dt, const MotionNoise& noise);
  [[nodiscard]] Vector6 replace_open(const Vector6& expected, double dt, const MotionNoise& noise,
                                     const OpenMotion& open);
  void carry(const SE3& motion);

  MotionState state_;
  Uncertainty uncertainty_;
  Matrix12 transition_ = Matrix12::Identity();  // of the last predict()
  Matrix12 local_before_ = Matrix12::Zero();    // before the last predict()
  Matrix12 process_ = Matrix12::Zero();
  Matrix6 step_covariance_ = Matrix6::Zero();
  MotionState before_;                    // before the last predict()
  double dt_ = 0;                         // of the last predict()
  Vector6 gap_ = Vector6::Zero();         // mean over some scans of: motion per second − twist
  Vector6 correction_ = Vector6::Zero();  // of the twist, by the next predict()
};

[[nodiscard]] MotionState operator+(const MotionState& x, const Vector12& step);

}  // namespace cairn::odometry
