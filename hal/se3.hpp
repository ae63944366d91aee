// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace cairn {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Skew-symmetric matrix of v: hat(v) w = v × w.
[[nodiscard]] Eigen::Matrix3d hat(const Eigen::Vector3d& v);

/// A rigid motion. `T_a_b` takes a point in frame b to frame a.
///
/// Tangent vectors are ordered (translation, rotation), in metres and radians; perturbations act on the right:
/// T ⊞ ξ = T·exp(ξ). Conventions as in Solà, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics".
class SE3 {
 public:
  SE3() = default;
  /// `rotation` is normalised.
  SE3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
      : rotation_(rotation.normalized()), translation_(translation) {}
  SE3(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation)
      : SE3(Eigen::Quaterniond(rotation), translation) {}

  /// Fixed-axis roll, pitch, yaw in radians (REP-103, URDF `rpy`): R = Rz(yaw)·Ry(pitch)·Rx(roll).
  [[nodiscard]] static SE3 from_xyz_rpy(const Vector6& xyz_rpy);
  [[nodiscard]] Vector6 xyz_rpy() const;

  /// The motion with the tangent vector `xi`: translation in metres first, then rotation in radians.
  [[nodiscard]] static SE3 exp(const Vector6& xi);
  /// The ξ with exp(ξ) = *this and a rotation angle in [0, π].
  [[nodiscard]] Vector6 log() const;

  [[nodiscard]] const Eigen::Quaterniond& quaternion() const { return rotation_; }
  [[nodiscard]] Eigen::Matrix3d rotation() const { return rotation_.toRotationMatrix(); }
  [[nodiscard]] const Eigen::Vector3d& translation() const { return translation_; }
  [[nodiscard]] Eigen::Matrix4d matrix() const;

  [[nodiscard]] SE3 inverse() const;
  [[nodiscard]] SE3 operator*(const SE3& other) const;
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation_ * p + translation_; }

  /// Ad with T·exp(ξ)·T⁻¹ = exp(Ad ξ).
  [[nodiscard]] Matrix6 adjoint() const;

 private:
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

/// J_r(ξ) with exp(ξ + δ) ≈ exp(ξ)·exp(J_r δ).
[[nodiscard]] Matrix6 right_jacobian(const Vector6& xi);
[[nodiscard]] Matrix6 right_jacobian_inverse(const Vector6& xi);
/// The smallest rotation that takes the direction of `from` to that of `to`. Eigen's FromTwoVectors, compiled once.
[[nodiscard]] Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
/// Angle in radians of the rotation part, in [0, π].
[[nodiscard]] double rotation_angle(const SE3& T);

/// A motion and the covariance of its right perturbation: T = mean·exp(ξ), ξ ~ N(0, covariance).
struct UncertainPose {
  SE3 mean;
  Matrix6 covariance = Matrix6::Zero();
};
/// First-order: Ad_b⁻¹ Σ_a Ad_b⁻ᵀ + Σ_b, for independent a and b.
[[nodiscard]] UncertainPose compose(const UncertainPose& a, const UncertainPose& b);
[[nodiscard]] UncertainPose inverse(const UncertainPose& a);

}  // namespace cairn
