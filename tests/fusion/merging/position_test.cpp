// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/position.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace cairn::merging {
namespace {

UncertainPose pose() {
  UncertainPose T;
  T.mean = SE3::exp((Vector6() << 1, -2, 0.5, 0.3, -0.2, 0.9).finished());
  Matrix6 A;
  std::mt19937 random(1);
  for (int i = 0; i < 36; ++i) A(i) = static_cast<double>(random() % 1000) / 1000 - 0.5;
  T.covariance = 1e-4 * A * A.transpose();
  return T;
}

TEST(Moved, IsTheCovarianceOfManyDraws) {
  const UncertainPose T = pose();
  const Position x{{3, 1, -2}, Eigen::Vector3d(4e-4, 1e-4, 2e-4).asDiagonal()};
  const Position y = moved(T, x);
  const Matrix6 root = T.covariance.llt().matrixL();
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 40000;
  for (int i = 0; i < kDraws; ++i) {
    Vector6 xi;
    Eigen::Vector3d noise;
    for (double& v : xi) v = normal(random);
    for (double& v : noise) v = normal(random);
    const Eigen::Vector3d at = x.mean + Eigen::Vector3d(x.covariance.diagonal().cwiseSqrt().cwiseProduct(noise));
    const Eigen::Vector3d d = T.mean * SE3::exp(root * xi) * at - y.mean;
    sum += d * d.transpose();
  }
  EXPECT_LT((sum / kDraws - y.covariance).norm(), 0.03 * y.covariance.norm());
}

TEST(Product, IsTheInformationForm) {
  const Position a{{1, 2, 3}, Eigen::Vector3d(0.01, 0.04, 0.02).asDiagonal()};
  Position b{{1.1, 1.9, 3.2}, Eigen::Vector3d(0.03, 0.01, 0.05).asDiagonal()};
  b.covariance(0, 1) = b.covariance(1, 0) = 0.005;
  const Position c = product(a, b), d = product(b, a);
  const Eigen::Matrix3d information = a.covariance.inverse() + b.covariance.inverse();
  EXPECT_LT((c.covariance - information.inverse()).norm(), 1e-12);
  EXPECT_LT(
      (c.mean - information.inverse() * (a.covariance.inverse() * a.mean + b.covariance.inverse() * b.mean)).norm(),
      1e-12);
  EXPECT_LT(c.covariance.trace(), std::min(a.covariance.trace(), b.covariance.trace()));
  EXPECT_LT((c.mean - d.mean).norm() + (c.covariance - d.covariance).norm(), 1e-12);
}

TEST(VoxelCovariance, ShrinksWithCertainty) {
  EXPECT_NEAR(voxel_covariance(1, 0.1)(0, 0), 0.0025, 1e-15);
  EXPECT_GT(voxel_covariance(0.6, 0.1).trace(), voxel_covariance(0.9, 0.1).trace());
}

}  // namespace
}  // namespace cairn::merging
