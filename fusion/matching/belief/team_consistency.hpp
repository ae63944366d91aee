// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/se3.hpp"

namespace cairn::matching {

/// 99.9 % bound of χ² with 6 degrees of freedom: a squared distance2() above it is no chance.
inline constexpr double kChi2 = 22.46;

/// The pose of a comparison with the covariance of two maps that bend: 0.15 m and 1.5° (standard
/// deviations) more.
[[nodiscard]] UncertainPose bent(const UncertainPose& pose);
/// Squared Mahalanobis distance.
[[nodiscard]] double distance2(const Vector6& error, const Matrix6& covariance);

/// A claim about two robots of a team: the pose of b's map in a's. There may be several about one
/// pair.
struct Claim {
  int a = 0, b = 0;  ///< robots
  UncertainPose T_a_b;
  double probability = 0;  ///< that the claim is right, taken by itself
};

/// The claims of a set that can be true together.
struct Agreement {
  std::vector<bool> kept;   ///< for each claim
  std::vector<int> closed;  ///< for each claim, loops of kept claims that it closes or is a part of
};

/// Claims that are considered, at most: the most probable. A bound on time, which may grow with 2
/// to the power of the number of claims.
inline constexpr std::size_t kMostClaims = 16;

/// The subset of claims whose loops all close, with the largest sum of log-odds. Each loop adds
/// more to the sum, because wrong claims rarely close a loop by chance. The result is exact.
/// Method: pairwise consistency maximisation (Mangelson et al., ICRA 2018), over loops of any
/// length. A loop closes if its error is below kChi2, weighted by the covariances along it, each
/// with bent(). The order of the claims does not matter, unless two have equal probabilities.
[[nodiscard]] Agreement agreement_of(std::span<const Claim> claims);

}  // namespace cairn::matching
