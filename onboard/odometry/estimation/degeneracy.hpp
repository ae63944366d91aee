// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "hal/se3.hpp"
#include "onboard/odometry/estimation/normal_equations.hpp"

namespace cairn::odometry {

/// Which motions the matched patches do not determine.
struct Degeneracy {
  int count = 0;
  /// The first `count` are valid: unit directions of (translation, rotation·length) in base_link.
  std::array<Vector6, 6> directions{};
  double length_m = 1;  ///< rotations are compared with translations at this lever arm
  /// Takes a Jacobian row a to the part of it that carries information: P a. Identity when nothing
  /// is degenerate.
  Matrix6 keep = Matrix6::Identity();
  /// Projects a right perturbation of the pose (or the twist) onto the undetermined directions.
  Matrix6 undetermined = Matrix6::Zero();
};

/// Finds the degenerate directions. Noisy normals seem to constrain every direction: where all
/// surfaces are parallel to an axis, Σ w a aᵀ is still not singular along it. So every principal
/// direction of the scaled information is judged by its points: how many move towards or away from
/// their surface, when the base moves in that direction? A point whose motion makes an angle α with
/// its surface counts sin²α, and nothing below 6°, where normals are noise. A direction with a sum
/// below `min_facing_points` is degenerate. (Counting strong contributions is the idea of X-ICP,
/// Tuna et al., T-RO 2023.)
[[nodiscard]] Degeneracy find_degeneracy(const NormalEquations& n, std::span<const ResidualRow> rows,
                                         double min_facing_points);

/// The equations without what they say about the undetermined directions.
[[nodiscard]] NormalEquations without_degenerate(const NormalEquations& n, const Degeneracy& d);

}  // namespace cairn::odometry
