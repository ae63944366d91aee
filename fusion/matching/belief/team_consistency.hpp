// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/se3.hpp"

namespace cairn::matching {

inline constexpr double kChi2 = 22.46;  ///< bound on 99.9 % of squared distances, with 6 degrees of freedom

/// What a comparison of two maps says, allowing for what maps bend: 0.15 m and 1.5° more.
[[nodiscard]] UncertainPose bent(const UncertainPose& pose);
/// Squared Mahalanobis distance.
[[nodiscard]] double distance2(const Vector6& error, const Matrix6& covariance);

/// A claim about two robots of a team: where the map of `b` lies in that of `a`. There may be several about one pair.
struct Claim {
  int a = 0, b = 0;
  UncertainPose T_a_b;
  double probability = 0;  ///< that it is right, taken by itself
};

/// What of a set of claims can be true together.
struct Agreement {
  std::vector<bool> kept;   ///< for each claim
  std::vector<int> closed;  ///< for each claim, loops of kept claims that it closes or is a part of
};

inline constexpr std::size_t kMostClaims = 16;  ///< the most probable; more are not kept

/// The subset of claims whose loops all close and whose log-odds, with `kLoopWorth` more for each loop, have the
/// largest sum (pairwise consistency maximisation of Mangelson et al., ICRA 2018, over loops of any length; exact).
/// A loop closes when its error, weighted by the covariances along it and by what maps bend (0.15 m and 1.5° for each
/// claim), is below the 99.9 % bound of χ² with 6 degrees of freedom. Wrong claims close loops by chance once in a
/// building, so a loop says more than a claim. The order of the claims does not matter, but for equals.
[[nodiscard]] Agreement agreement_of(std::span<const Claim> claims);

}  // namespace cairn::matching
