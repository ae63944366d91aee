// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/motion_filter.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace cairn {
namespace {

using Matrix12x6 = Eigen::Matrix<double, 12, 6>;

/// Hessian of ½·Σ w r² over (δ, ν), see NormalEquations.
Matrix12 information(const Measurement& m) {
  const NormalEquations& n = m.equations;
  Matrix12 H;
  H << n.aa, -n.taa, -n.taa, n.ttaa;
  return H / m.variance_scale;
}

Matrix12 inverse_of(const Matrix12& m) { return m.ldlt().solve(Matrix12::Identity()); }

Matrix12 symmetric(const Matrix12& m) { return 0.5 * (m + m.transpose()); }

/// The covariance without what couples the undetermined motions to the others. The directions themselves are known to a
/// few milliradians only: with metres of uncertainty along one of them, the coupling would let a perfectly measured
/// other direction pretend to measure it too.
Matrix12 decoupled(const Matrix12& P, const Degeneracy& d) {
  if (d.count == 0) return P;
  Matrix12 lose = Matrix12::Zero();
  lose.topLeftCorner<6, 6>() = lose.bottomRightCorner<6, 6>() = d.undetermined;
  const Matrix12 keep = Matrix12::Identity() - lose;
  return symmetric(lose * P * lose.transpose() + keep * P * keep.transpose());
}

/// ∫ of white acceleration: the twist wanders as √t, the pose with its integral.
Matrix12 process_noise(double dt, const MotionNoise& noise) {
  Vector6 deviation;
  deviation << noise.horizontal, noise.horizontal, noise.vertical, noise.tilting, noise.tilting, noise.turning;
  const Matrix6 q = (dt * dt * deviation.cwiseAbs2()).asDiagonal();
  Matrix12 Q;
  Q << q * (dt * dt / 3), q * (dt / 2), q * (dt / 2), q;
  return Q;
}

}  // namespace

MotionState operator+(const MotionState& x, const Vector12& step) {
  return {x.T_odom_base * SE3::exp(step.head<6>()), x.twist + step.tail<6>()};
}

void MotionFilter::reset(const MotionState& state, const Uncertainty& uncertainty) {
  state_ = state;
  uncertainty_ = uncertainty;
  step_covariance_.setZero();
}

void MotionFilter::forget_twist(const Matrix6& covariance) {
  state_.twist.setZero();
  for (Matrix12* P : {&uncertainty_.local, &uncertainty_.total}) {
    P->rightCols<6>().setZero();
    P->bottomRows<6>().setZero();
    P->bottomRightCorner<6, 6>() = covariance;
  }
}

void MotionFilter::predict(double dt, const MotionNoise& noise) {
  const Vector6 xi = dt * state_.twist;
  const SE3 motion = SE3::exp(xi);
  transition_.setIdentity();
  transition_.topLeftCorner<6, 6>() = motion.inverse().adjoint();
  transition_.topRightCorner<6, 6>() = dt * right_jacobian(xi);
  process_ = process_noise(dt, noise);
  local_before_ = uncertainty_.local;
  uncertainty_.local = symmetric(transition_ * uncertainty_.local * transition_.transpose() + process_);
  uncertainty_.total = symmetric(transition_ * uncertainty_.total * transition_.transpose() + process_);
  state_.T_odom_base = state_.T_odom_base * motion;
  Matrix12 by_twist = transition_;
  by_twist.topLeftCorner<6, 6>().setZero();
  step_covariance_ = (by_twist * local_before_ * by_twist.transpose() + process_).topLeftCorner<6, 6>();
}

Vector12 MotionFilter::step(const MotionState& x, const Measurement& m) const {
  const Matrix12 prior = inverse_of(decoupled(uncertainty_.local, m.degeneracy));
  Vector12 from_prior, gradient;
  from_prior << (state_.T_odom_base.inverse() * x.T_odom_base).log(), x.twist - state_.twist;
  gradient << m.equations.ar, -m.equations.tar;
  gradient = gradient / m.variance_scale + prior * from_prior;
  return -(information(m) + prior).ldlt().solve(gradient);
}

double MotionFilter::innovation(const MotionState& x) const {
  const Vector6 e = (state_.T_odom_base.inverse() * x.T_odom_base).log();
  return std::sqrt(e.dot(uncertainty_.local.topLeftCorner<6, 6>().ldlt().solve(e)) / 6);
}

void MotionFilter::update(const MotionState& x, const Measurement& m, const Matrix6& map_covariance) {
  const Matrix12 H = information(m);
  const Matrix12 prior = inverse_of(decoupled(uncertainty_.local, m.degeneracy));
  const Matrix12 posterior = symmetric(inverse_of(H + prior));
  const Matrix12 keep = posterior * prior;                      // what remains of the prediction's error
  const Matrix12x6 follow = posterior * H.leftCols<6>();        // what is taken over from the map's
  const Matrix12 noise = symmetric(posterior * H * posterior);  // what the scan adds
  const Matrix6 ad = x.T_odom_base.inverse().adjoint();
  const Matrix6 map_error = ad * map_covariance * ad.transpose();
  uncertainty_.total = symmetric(keep * uncertainty_.total * keep.transpose() +
                                 follow * map_error * follow.transpose() + m.drift_scale * noise);
  uncertainty_.local = posterior;
  // Error of the motion = error now − the old error carried along.
  Matrix12 carried = Matrix12::Zero();
  carried.topLeftCorner<6, 6>() = transition_.topLeftCorner<6, 6>();
  const Matrix12 G = keep * transition_ - carried;
  step_covariance_ =
      (G * local_before_ * G.transpose() + keep * process_ * keep.transpose() + noise).topLeftCorner<6, 6>();
  state_ = x;
}

}  // namespace cairn
