// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "hal/se3.hpp"
#include "onboard/odometry/normal_equations.hpp"

namespace cairn {

/// Which motions the matched planes do not determine.
struct Degeneracy {
  int count = 0;
  /// The first `count` are valid: unit directions of (translation, rotation·length) in base_link.
  std::array<Vector6, 6> directions{};
  double length_m = 1;  ///< rotations are compared with translations at this lever arm
  /// Takes a Jacobian row a to the part of it that carries real information: P a. Identity when nothing is degenerate.
  Matrix6 keep = Matrix6::Identity();
};

/// Noisy normals look as if they constrained every direction: where all planes are parallel to an axis, Σ w a aᵀ is
/// still not singular along it. The expected amount of that false information is known (`spurious`); each eigenvector
/// of the scaled information keeps only what exceeds a multiple of it, and is degenerate if less than half remains or
/// if what remains leaves a standard deviation above `max_std_m`, after the loss by `correlation`.
[[nodiscard]] Degeneracy find_degeneracy(const NormalEquations& n, double max_std_m, double correlation);

/// The equations without the false information.
[[nodiscard]] NormalEquations without_degenerate(const NormalEquations& n, const Degeneracy& d);

}  // namespace cairn
