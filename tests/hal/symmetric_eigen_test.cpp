// SPDX-License-Identifier: Apache-2.0
#include "hal/symmetric_eigen.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cairn {
namespace {

Matrix6 symmetric() {
  Matrix6 m;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) m(i, j) = 1.0 / (i + j + 1) - (i == j ? 0.3 : 0.0);
  return m;
}

TEST(SymmetricEigen, TheMatrixStretchesEachVectorByItsValue) {
  const SymmetricEigen eigen = symmetric_eigen(symmetric());
  ASSERT_TRUE(eigen.converged);
  for (int k = 0; k < 6; ++k) {
    EXPECT_LT((symmetric() * eigen.vectors.col(k) - eigen.values[k] * eigen.vectors.col(k)).norm(), 1e-12);
    EXPECT_NEAR(eigen.vectors.col(k).norm(), 1, 1e-12);
    if (k > 0) {
      EXPECT_LE(eigen.values[k - 1], eigen.values[k]);
    }
  }
}

TEST(SymmetricEigen, ReadsTheLowerTriangleAlone) {
  Matrix6 m = symmetric();
  m(0, 5) = 1e6;
  EXPECT_EQ(symmetric_eigen(m).values, symmetric_eigen(symmetric()).values);
}

TEST(SymmetricEigen, SaysThatANaNHasNone) {
  Matrix6 m = symmetric();
  m(3, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(symmetric_eigen(m).converged);
}

TEST(SymmetricEigen, ValuesOfTwoRows) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.3).toRotationMatrix();
  const Eigen::Vector2d values = symmetric_eigenvalues(turn * Eigen::Vector2d(5, -2).asDiagonal() * turn.transpose());
  EXPECT_NEAR(values[0], -2, 1e-12);
  EXPECT_NEAR(values[1], 5, 1e-12);
}

}  // namespace
}  // namespace cairn
