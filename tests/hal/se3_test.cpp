// SPDX-License-Identifier: Apache-2.0
#include "hal/se3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace cairn {
namespace {

class Random {
 public:
  Vector6 tangent(double scale) {
    Vector6 v;
    for (double& x : v) x = scale * uniform_(engine_);
    return v;
  }

 private:
  std::mt19937 engine_{7};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

Matrix6 numerical_jacobian(const std::function<Vector6(const Vector6&)>& f) {
  constexpr double h = 1e-6;
  Matrix6 J;
  for (int k = 0; k < 6; ++k) {
    const Vector6 d = h * Vector6::Unit(k);
    J.col(k) = (f(d) - f(-d)) / (2 * h);
  }
  return J;
}

TEST(SE3, LogIsTheInverseOfExpFromTinyToLargeAngles) {
  Random random;
  for (const double scale : {1e-12, 1e-6, 9e-5, 1.1e-4, 1e-2, 0.5, 1.7})
    for (int i = 0; i < 50; ++i) {
      const Vector6 xi = random.tangent(scale);
      EXPECT_LT((SE3::exp(xi).log() - xi).norm(), 1e-12 + 1e-9 * scale) << xi.transpose();
    }
}

TEST(SE3, RightJacobianEqualsTheNumericalOne) {
  Random random;
  for (const double scale : {1e-8, 1e-3, 0.02, 0.04, 0.3, 1.5})
    for (int i = 0; i < 20; ++i) {
      const Vector6 xi = random.tangent(scale);
      const auto f = [&](const Vector6& d) -> Vector6 { return (SE3::exp(xi).inverse() * SE3::exp(xi + d)).log(); };
      EXPECT_LT((right_jacobian(xi) - numerical_jacobian(f)).norm(), 1e-8);
      EXPECT_LT((right_jacobian(xi) * right_jacobian_inverse(xi) - Matrix6::Identity()).norm(), 1e-12);
    }
}

TEST(SE3, AdjointMovesAPerturbationAcrossTheTransform) {
  Random random;
  for (int i = 0; i < 50; ++i) {
    const SE3 T = SE3::exp(random.tangent(2.0));
    const Vector6 xi = random.tangent(0.5);
    const SE3 difference = (T * SE3::exp(xi) * T.inverse()).inverse() * SE3::exp(T.adjoint() * xi);
    EXPECT_LT(difference.log().norm(), 1e-10);
  }
}

TEST(SE3, RotationBetweenTwoDirectionsTakesTheShortestWay) {
  const Eigen::Vector3d a(1, 2, 3), b(-2, 0.5, 1);
  const Eigen::Quaterniond q = rotation_between(a, b);
  EXPECT_LT((q * a.normalized() - b.normalized()).norm(), 1e-12);
  const Eigen::AngleAxisd turn(q);
  EXPECT_NEAR(std::abs(turn.axis().dot(a)) + std::abs(turn.axis().dot(b)), 0, 1e-12);
  EXPECT_LT((rotation_between(a, -a) * a + a).norm(), 1e-6) << "any half turn about an axis across";
}

TEST(SE3, ComposeAndInverseCovarianceUseTheNumericalJacobians) {
  Random random;
  const SE3 a = SE3::exp(random.tangent(1.5)), b = SE3::exp(random.tangent(1.5));
  const auto through_a = [&](const Vector6& d) -> Vector6 { return ((a * b).inverse() * (a * SE3::exp(d) * b)).log(); };
  const auto through_inverse = [&](const Vector6& d) -> Vector6 { return (a * (a * SE3::exp(d)).inverse()).log(); };
  const Matrix6 root = Matrix6::Random();
  const UncertainPose ua{a, root * root.transpose()}, ub{b, 2.0 * Matrix6::Identity()};
  const Matrix6 Ja = numerical_jacobian(through_a), Ji = numerical_jacobian(through_inverse);
  const Matrix6 composed = Ja * ua.covariance * Ja.transpose() + ub.covariance;
  EXPECT_LT((compose(ua, ub).covariance - composed).norm() / composed.norm(), 1e-8);
  const Matrix6 inverted = Ji * ua.covariance * Ji.transpose();
  EXPECT_LT((inverse(ua).covariance - inverted).norm() / inverted.norm(), 1e-8);
}

TEST(SE3, RollPitchYawIsFixedAxisAsInUrdf) {
  Vector6 v;
  v << 1, 2, 3, 0.1, -0.2, 2.5;
  EXPECT_LT((SE3::from_xyz_rpy(v).xyz_rpy() - v).norm(), 1e-12);
  const SE3 yaw_left = SE3::from_xyz_rpy((Vector6() << 0, 0, 0, 0, 0, 0.5 * std::acos(-1.0)).finished());
  EXPECT_LT((yaw_left * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

}  // namespace
}  // namespace cairn
