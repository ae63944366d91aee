// SPDX-License-Identifier: Apache-2.0
#include "hal/se3.hpp"

#include <Eigen/LU>
#include <cmath>

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Below this angle the closed forms lose digits to cancellation and the Taylor series are exact to rounding.
constexpr double kSmallAngle = 1e-4;

Quaterniond exp_so3(const Vector3d& phi) {
  const double angle = phi.norm();
  const double k = angle < kSmallAngle ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  return Quaterniond(std::cos(0.5 * angle), k * phi.x(), k * phi.y(), k * phi.z());
}

Vector3d log_so3(const Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double n = q.vec().norm();
  const double w = sign * q.w();
  const double k = n < kSmallAngle ? 2.0 / w - 2.0 * n * n / (3.0 * w * w * w) : 2.0 * std::atan2(n, w) / n;
  return sign * k * q.vec();
}

/// Left Jacobian of SO(3) (Solà et al., eq. 145).
Matrix3d left_jacobian_so3(const Vector3d& phi) {
  const double a = phi.norm(), a2 = a * a;
  const bool small = a < kSmallAngle;
  const double b = small ? 0.5 - a2 / 24.0 : (1.0 - std::cos(a)) / a2;
  const double c = small ? 1.0 / 6.0 - a2 / 120.0 : (a - std::sin(a)) / (a2 * a);
  const Matrix3d K = hat(phi);
  return Matrix3d::Identity() + b * K + c * K * K;
}

/// The coupling block of the left Jacobian of SE(3) (Barfoot, State Estimation for Robotics, eq. 7.86; Solà eq. 180).
Matrix3d coupling(const Vector3d& rho, const Vector3d& phi) {
  const double a = phi.norm(), a2 = a * a, a4 = a2 * a2;
  // The third coefficient loses all digits first: its numerator is O(a⁵).
  const bool small = a < 5e-2;
  const double c1 = small ? 1.0 / 6.0 - a2 / 120.0 + a4 / 5040.0 : (a - std::sin(a)) / (a2 * a);
  const double c2 = small ? 1.0 / 24.0 - a2 / 720.0 + a4 / 40320.0 : (a2 + 2.0 * std::cos(a) - 2.0) / (2.0 * a4);
  const double c3 = small ? 1.0 / 120.0 - a2 / 2520.0 + a4 / 120960.0
                          : (2.0 * a - 3.0 * std::sin(a) + a * std::cos(a)) / (2.0 * a4 * a);
  const Matrix3d P = hat(rho), K = hat(phi);
  return 0.5 * P + c1 * (K * P + P * K + K * P * K) + c2 * (K * K * P + P * K * K - 3.0 * K * P * K) +
         c3 * (K * P * K * K + K * K * P * K);
}

Matrix6 left_jacobian(const Vector6& xi) {
  const Matrix3d J = left_jacobian_so3(xi.tail<3>());
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>() = J;
  out.topRightCorner<3, 3>() = coupling(xi.head<3>(), xi.tail<3>());
  out.bottomRightCorner<3, 3>() = J;
  return out;
}

}  // namespace

Matrix3d hat(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

SE3 SE3::from_xyz_rpy(const Vector6& v) {
  const Quaterniond q = Eigen::AngleAxisd(v[5], Vector3d::UnitZ()) * Eigen::AngleAxisd(v[4], Vector3d::UnitY()) *
                        Eigen::AngleAxisd(v[3], Vector3d::UnitX());
  return {q, v.head<3>()};
}

Vector6 SE3::xyz_rpy() const {
  const Matrix3d R = rotation();
  Vector6 v;
  v << translation_, std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))),
      std::atan2(R(1, 0), R(0, 0));
  return v;
}

SE3 SE3::exp(const Vector6& xi) { return {exp_so3(xi.tail<3>()), left_jacobian_so3(xi.tail<3>()) * xi.head<3>()}; }

Vector6 SE3::log() const {
  const Vector3d phi = log_so3(rotation_);
  Vector6 xi;
  xi << left_jacobian_so3(phi).partialPivLu().solve(translation_), phi;
  return xi;
}

Eigen::Matrix4d SE3::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation();
  m.topRightCorner<3, 1>() = translation_;
  return m;
}

SE3 SE3::inverse() const { return {rotation_.conjugate(), -(rotation_.conjugate() * translation_)}; }

SE3 SE3::operator*(const SE3& other) const {
  return {rotation_ * other.rotation_, rotation_ * other.translation_ + translation_};
}

Matrix6 SE3::adjoint() const {
  const Matrix3d R = rotation();
  Matrix6 ad = Matrix6::Zero();
  ad.topLeftCorner<3, 3>() = R;
  ad.topRightCorner<3, 3>() = hat(translation_) * R;
  ad.bottomRightCorner<3, 3>() = R;
  return ad;
}

Matrix6 right_jacobian(const Vector6& xi) { return left_jacobian(-xi); }

Matrix6 right_jacobian_inverse(const Vector6& xi) { return right_jacobian(xi).partialPivLu().inverse(); }

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

double rotation_angle(const SE3& T) { return log_so3(T.quaternion()).norm(); }

UncertainPose compose(const UncertainPose& a, const UncertainPose& b) {
  const Matrix6 ad = b.mean.inverse().adjoint();
  return {a.mean * b.mean, ad * a.covariance * ad.transpose() + b.covariance};
}

UncertainPose inverse(const UncertainPose& a) {
  const Matrix6 ad = a.mean.adjoint();
  return {a.mean.inverse(), ad * a.covariance * ad.transpose()};
}

}  // namespace cairn
