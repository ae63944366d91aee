// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fusion/matching/evidence/match_result.hpp"
#include "hal/budget.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Estimates the relative pose of one pair of maps. The result is deterministic. Every candidate
/// and every iteration is a step of the budget. When the budget is spent, the best pose so far is
/// the result.
class Matcher {
 public:
  virtual ~Matcher() = default;
  /// `initial` is the guess of T_a_b, with the covariance of its right perturbation (m, rad).
  /// Without one, the search covers all headings and distances, and z of both maps must be upwards
  /// within some degrees. The book's methods start at identity then.
  /// Errors: kInvalidConfig for a pose or covariance that is not finite or not positive definite.
  /// Maps that hold too little give a result that is not accepted.
  [[nodiscard]] virtual Result<MatchResult> match(const std::optional<UncertainPose>& initial,
                                                  Budget& budget) const = 0;

 protected:
  Matcher() = default;
  Matcher(const Matcher&) = default;
  Matcher& operator=(const Matcher&) = default;
};

/// A budget (steps) that no match of any method exceeds. Chosen by hand.
inline constexpr int kAmpleSteps = 100'000;

/// Covariance of a guess of which nothing else is known: standard deviations of 0.8 m, 6° of
/// heading, 0.3 m of height and 1.7° of tilt. Three of them cover the starts of the book's protocol
/// (±2 m, ±15°).
[[nodiscard]] inline Matrix6 default_prior_covariance() {
  constexpr double kPlace_m = 0.8, kHeight_m = 0.3, kTilt_rad = 0.03, kHeading_rad = 0.105;
  Vector6 sigma;
  sigma << kPlace_m, kPlace_m, kHeight_m, kTilt_rad, kTilt_rad, kHeading_rad;
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace cairn::matching
