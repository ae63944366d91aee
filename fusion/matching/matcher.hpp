// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fusion/matching/evidence/match_result.hpp"
#include "hal/budget.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Estimates relative poses of one pair of maps. Deterministic, and anytime: every mode and every iteration is a step
/// of the budget, and whatever was best so far is the result.
class Matcher {
 public:
  virtual ~Matcher() = default;
  /// `initial` is the guess of T_a_b with the covariance of its right perturbation (m, rad). Without one, the search
  /// covers all headings and distances, with z of both maps upwards within some degrees (the book's methods then start
  /// at identity). Errors: kInvalidConfig for a pose or covariance that is not finite or not positive definite. Maps
  /// with too little in them give a result that is not accepted.
  [[nodiscard]] virtual Result<MatchResult> match(const std::optional<UncertainPose>& initial,
                                                  Budget& budget) const = 0;

 protected:
  Matcher() = default;
  Matcher(const Matcher&) = default;
  Matcher& operator=(const Matcher&) = default;
};

/// Steps that a match of any method never exceeds.
inline constexpr int kAmpleSteps = 100'000;

/// Standard deviations of a guess of which nothing else is known: 0.8 m and 6°, so that the window covers the book's
/// protocol (±2 m, ±15°).
[[nodiscard]] inline Matrix6 default_prior_covariance() {
  Vector6 sigma;
  sigma << 0.8, 0.8, 0.3, 0.03, 0.03, 0.105;
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace cairn::matching
