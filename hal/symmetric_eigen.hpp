// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/se3.hpp"

namespace cairn {

/// The eigenvalues of a symmetric matrix, ascending, and its eigenvectors of length 1, one in each column.
struct SymmetricEigen {
  Vector6 values;
  Matrix6 vectors;
  bool converged = false;  ///< false where the matrix has a NaN
};

/// Reads the lower triangle of `matrix` alone. Eigen's SelfAdjointEigenSolver, compiled once: for six rows it takes
/// each file that names it four seconds.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Matrix6& matrix);
/// Ascending.
[[nodiscard]] Eigen::Vector2d symmetric_eigenvalues(const Eigen::Matrix2d& matrix);

}  // namespace cairn
