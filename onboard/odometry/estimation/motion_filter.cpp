// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/motion_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

/// Hessian of ½·Σ w r² over (δ, ν), see NormalEquations.
Matrix12 information(const NormalEquations& n, double overconfidence) {
  Matrix12 H;
  H << n.aa, -n.taa, -n.taa, n.ttaa;
  return H / overconfidence;
}

// Shares per scan: how fast the mean gap between motion and twist follows, and how much of it a
// prediction corrects. Of the values tried they hold a wrong twist best. A robot in a simulated
// office that an acceleration of 3 m/s² leads 15 m astray errs by 0.7 m with them, by 1.3 m with
// half of both, by 2.2 m with a quarter of the second. A single scan's pose error reaches the twist
// as 0.2 · 0.4 = 0.08 of it per scan's time: less than the acceleration's noise.
constexpr double kGapShare = 0.2;
constexpr double kCorrectedShare = 0.4;

// s. Roll and pitch of a body on springs, on legs or in the air swing within half a second: a rate
// says nothing of what comes after a quarter of it.
constexpr double kTiltMemory_s = 0.15;

// Of a place where a scan fits. Chosen by hand: right ones are off by centimetres and a tenth of a degree.
constexpr double kFound_m = 0.2, kFound_rad = 0.02;

Matrix12 inverse_of(const Matrix12& m) { return m.ldlt().solve(Matrix12::Identity()); }

Matrix12 symmetric(const Matrix12& m) { return 0.5 * (m + m.transpose()); }

/// The covariance without what couples the undetermined motions to the others. The directions
/// themselves are known to a few milliradians only: with metres of uncertainty along one of them,
/// the coupling would let a perfectly measured other direction pretend to measure it too.
Matrix12 decoupled(const Matrix12& P, const Degeneracy& d) {
  if (d.count == 0) return P;
  Matrix12 lose = Matrix12::Zero();
  lose.topLeftCorner<6, 6>() = lose.bottomRightCorner<6, 6>() = d.undetermined;
  const Matrix12 keep = Matrix12::Identity() - lose;
  return lose * P * lose.transpose() + keep * P * keep.transpose();
}

}  // namespace

MotionState operator+(const MotionState& x, const Vector12& step) {
  return {x.T_odom_base * SE3::exp(step.head<6>()), x.twist + step.tail<6>()};
}

void MotionFilter::reset(const MotionState& state, const Uncertainty& uncertainty) {
  state_ = before_ = state;
  uncertainty_ = uncertainty;
  step_covariance_.setZero();
  forget_gap();
}

void MotionFilter::forget_gap() {
  gap_.setZero();
  correction_.setZero();
}

void MotionFilter::doubt_twist(const Vector6& share) {
  const Vector6 taken = (Vector6::Ones() - share).cwiseProduct(state_.twist);
  state_.twist -= taken;
  const Matrix6 doubt = taken.cwiseAbs2().asDiagonal();
  uncertainty_.local.bottomRightCorner<6, 6>() += doubt;
  uncertainty_.total.bottomRightCorner<6, 6>() += doubt;
  forget_gap();
}

void MotionFilter::predict(double dt, const MotionNoise& noise, const OpenMotion* open) {
  Vector6 xi = expect(dt, noise);
  if (open != nullptr) xi = replace_open(xi, dt, noise, *open);
  carry(SE3::exp(xi));
}

/// Takes the twist's part along open directions out of transition and process, and puts the measured motion in its
/// place. Returns the motion as a tangent vector.
Vector6 MotionFilter::replace_open(const Vector6& expected, double dt, const MotionNoise& noise,
                                   const OpenMotion& open) {
  const Matrix6& U = open.directions;
  const Matrix6 keep = Matrix6::Identity() - U;
  Matrix12 keep_both = Matrix12::Zero();
  keep_both.topLeftCorner<6, 6>() = keep_both.bottomRightCorner<6, 6>() = keep;
  const Vector6 xi = keep * expected + U * open.motion;
  state_.twist = keep * state_.twist + U * open.motion / dt;
  transition_.topLeftCorner<6, 6>() = SE3::exp(xi).inverse().adjoint();
  transition_.rightCols<6>() = keep_both * transition_.rightCols<6>();
  process_ = keep_both * process_ * keep_both.transpose();
  // The mean speed since the scan is not that of now: the acceleration's noise stands for the difference.
  const Matrix6 measured = U * open.covariance * U.transpose();
  const Matrix6 changed = U * (noise.acceleration * dt).cwiseAbs2().asDiagonal() * U.transpose();
  process_.topLeftCorner<6, 6>() += measured;
  process_.bottomRightCorner<6, 6>() += measured / (dt * dt) + changed;
  return xi;
}

/// Sets transition and process of a steady twist; returns the motion as a tangent vector.
Vector6 MotionFilter::expect(double dt, const MotionNoise& noise) {
  before_ = state_;
  dt_ = dt;
  state_.twist += correction_;
  correction_.setZero();
  // A body that tilts does not go on tilting.
  Vector6 moving_s = Vector6::Constant(dt);
  moving_s.segment<2>(3).setConstant(std::min(dt, kTiltMemory_s));
  const Vector6 xi = moving_s.cwiseProduct(state_.twist);
  const SE3 motion = SE3::exp(xi);
  transition_.setIdentity();
  transition_.topLeftCorner<6, 6>() = motion.inverse().adjoint();
  transition_.topRightCorner<6, 6>() = right_jacobian(xi) * moving_s.asDiagonal();
  const Matrix6 q = noise.acceleration.cwiseAbs2().asDiagonal();
  // ⅓ instead of ¼: an acceleration that varies within the step; it also keeps the matrix
  // invertible.
  process_ << q * (dt * dt * dt * dt / 3), q * (dt * dt * dt / 2), q * (dt * dt * dt / 2), q * (dt * dt);
  return xi;
}

void MotionFilter::predict_by(const UncertainPose& motion, const Vector6& twist, const Vector6& deviation, double dt) {
  before_ = state_;
  dt_ = dt;
  forget_gap();
  transition_.setZero();  // nothing is left of the twist before
  transition_.topLeftCorner<6, 6>() = motion.mean.inverse().adjoint();
  process_.setZero();
  process_.topLeftCorner<6, 6>() = motion.covariance;
  process_.bottomRightCorner<6, 6>() = deviation.cwiseAbs2().asDiagonal();
  state_.twist = twist;
  carry(motion.mean);
}

/// Moves state and uncertainty with transition_ and process_.
void MotionFilter::carry(const SE3& motion) {
  local_before_ = uncertainty_.local;
  uncertainty_.local = symmetric(transition_ * uncertainty_.local * transition_.transpose() + process_);
  uncertainty_.total = symmetric(transition_ * uncertainty_.total * transition_.transpose() + process_);
  state_.T_odom_base = state_.T_odom_base * motion;
  Matrix12 carried = transition_;
  carried.topLeftCorner<6, 6>().setZero();
  step_covariance_ = (carried * local_before_ * carried.transpose() + process_).topLeftCorner<6, 6>();
}

Vector12 MotionFilter::step(const MotionState& x, const Measurement& m) const {
  const NormalEquations& n = m.equations;
  const Matrix12 prior = inverse_of(decoupled(uncertainty_.local, m.degeneracy));
  Vector12 from_prior;
  from_prior << (state_.T_odom_base.inverse() * x.T_odom_base).log(), x.twist - state_.twist;
  Vector12 gradient;
  gradient << n.ar, -n.tar;
  gradient = gradient / m.overconfidence + prior * from_prior;
  return -(information(n, m.overconfidence) + prior).ldlt().solve(gradient);
}

void MotionFilter::update(const MotionState& x, const Measurement& m, const Matrix6& map_covariance) {
  const NormalEquations& n = m.equations;
  const Matrix12 H = information(n, m.overconfidence);
  const Matrix12 prior = inverse_of(decoupled(uncertainty_.local, m.degeneracy));
  const Matrix12 posterior = symmetric(inverse_of(H + prior));
  const Matrix12 keep = posterior * prior;  // what remains of the prediction's error
  const Matrix12 noise = symmetric(posterior * H * posterior);
  const Matrix12x6 follow = posterior * H.leftCols<6>();
  const Matrix6 ad = x.T_odom_base.inverse().adjoint();
  const Matrix6 map_error = ad * map_covariance * ad.transpose();
  uncertainty_.total =
      symmetric(keep * uncertainty_.total * keep.transpose() + follow * map_error * follow.transpose() + noise);
  uncertainty_.local = posterior;
  // Error of the motion = new error − the old one carried along.
  Matrix12 carried = Matrix12::Zero();
  carried.topLeftCorner<6, 6>() = transition_.topLeftCorner<6, 6>();
  const Matrix12 G = keep * transition_ - carried;
  step_covariance_ =
      (G * local_before_ * G.transpose() + keep * process_ * keep.transpose() + noise).topLeftCorner<6, 6>();
  state_ = x;
}

UncertainPose MotionFilter::pose() const {
  return {.mean = state_.T_odom_base, .covariance = uncertainty_.total.topLeftCorner<6, 6>()};
}

double MotionFilter::squared_surprise(const SE3& T_odom_base) const {
  const Vector6 off = (state_.T_odom_base.inverse() * T_odom_base).log();
  const Matrix6 P = uncertainty_.local.topLeftCorner<6, 6>();
  return off.dot(P.ldlt().solve(off));
}

bool MotionFilter::placed_within(double position_m, double heading_rad) const {
  const Matrix12& P = uncertainty_.local;
  return std::sqrt(std::max(P(0, 0), P(1, 1))) <= position_m && std::sqrt(P(5, 5)) <= heading_rad;
}

Matrix6 MotionFilter::odom_covariance() const {
  const Matrix6 ad = state_.T_odom_base.adjoint();
  return ad * uncertainty_.total.topLeftCorner<6, 6>() * ad.transpose();
}

UncertainPose MotionFilter::place_of_odom(bool found) const {
  Matrix6 covariance = uncertainty_.local.topLeftCorner<6, 6>();
  if (found) covariance = MotionNoise::of(kFound_m, kFound_rad).acceleration.cwiseAbs2().asDiagonal();
  return compose({state_.T_odom_base, covariance}, {state_.T_odom_base.inverse(), Matrix6::Zero()});
}

void MotionFilter::follow_motion() {
  if (dt_ <= 0) return;  // nothing was predicted
  const Vector6 motion = (before_.T_odom_base.inverse() * state_.T_odom_base).log() / dt_;
  gap_ += kGapShare * (motion - 0.5 * (before_.twist + state_.twist) - gap_);
  correction_ = kCorrectedShare * gap_;
}

}  // namespace cairn::odometry
