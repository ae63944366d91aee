// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/normal_equations.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace cairn::calibration {
namespace {

TEST(NormalEquations, AreThoseOfTheWholeMatrix) {
  constexpr Eigen::Index kShared = 3, kViews = 4, kRows = 80;
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 1);
  NormalEquations equations(kShared, kViews);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(kRows, kShared + 6 * kViews);
  Eigen::VectorXd r(kRows), w(kRows);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const Eigen::Index view = i % kViews;
    const Eigen::RowVectorXd shared = Eigen::RowVectorXd::NullaryExpr(kShared, [&] { return normal(random); });
    const Eigen::Matrix<double, 1, 6> pose = Eigen::RowVectorXd::NullaryExpr(6, [&] { return normal(random); });
    J.row(i).head(kShared) = shared;
    J.row(i).segment<6>(kShared + 6 * view) = pose;
    r[i] = normal(random);
    w[i] = 1 + 0.1 * static_cast<double>(i % 7);
    equations.add(static_cast<std::size_t>(view), shared, pose, r[i], w[i]);
  }
  const Eigen::MatrixXd H = J.transpose() * w.asDiagonal() * J;
  const Eigen::VectorXd step = -H.ldlt().solve(J.transpose() * w.asDiagonal() * r);
  const auto solved = equations.solve(0);
  ASSERT_TRUE(solved);
  EXPECT_LT((solved->shared - step.head(kShared)).norm(), 1e-9);
  for (Eigen::Index v = 0; v < kViews; ++v)
    EXPECT_LT((solved->poses[static_cast<std::size_t>(v)] - step.segment<6>(kShared + 6 * v)).norm(), 1e-9);
  const Eigen::MatrixXd whole = H.inverse().topLeftCorner(kShared, kShared);
  EXPECT_LT((covariance(equations.information(), 2) - 2 * whole).norm(), 1e-9);
}

TEST(NormalEquations, AFreeDirectionHasAnInfiniteVariance) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(3, 3);
  information.topLeftCorner(2, 2) << 4, 4, 4, 4;  // only the sum of the first two is known
  information(2, 2) = 100;
  const Eigen::MatrixXd sigma = covariance(information, 1);
  EXPECT_TRUE(std::isinf(sigma(0, 0)));
  EXPECT_TRUE(std::isinf(sigma(1, 1)));
  EXPECT_NEAR(sigma(2, 2), 0.01, 1e-12);
  EXPECT_TRUE(std::isinf(covariance(Eigen::MatrixXd::Zero(1, 1), 1)(0, 0)));
}

}  // namespace
}  // namespace cairn::calibration
