// SPDX-License-Identifier: Apache-2.0
#include "hal/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace cairn {

SymmetricEigen symmetric_eigen(const Matrix6& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(matrix);
  return {
      .values = solver.eigenvalues(), .vectors = solver.eigenvectors(), .converged = solver.info() == Eigen::Success};
}

Eigen::Vector2d symmetric_eigenvalues(const Eigen::Matrix2d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(matrix).eigenvalues();
}

}  // namespace cairn
