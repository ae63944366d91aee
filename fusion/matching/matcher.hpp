// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fusion/matching/evidence.hpp"
#include "fusion/matching/map_features.hpp"
#include "hal/budget.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Where two maps lie relative to each other, and what speaks for it.
struct MatchResult {
  UncertainPose T_a_b;             ///< takes a point of map b to map a; best so far, when the budget ran out
  double overlap = 0;              ///< ε of (4.21)
  double inlier_ratio = 0;         ///< of the pairs within the gate (4.20)
  double threshold = 0;            ///< the book's, on the inlier ratio, for this overlap (4.21)
  bool book_accepted = false;      ///< inlier_ratio above threshold: for comparison; it lets many wrong poses pass
  bool accepted = false;           ///< what to act on
  double probability_correct = 0;  ///< within 0.6 m and 6° of the truth
  std::string reason;              ///< why it was accepted or not, for people
  int iterations = 0;              ///< steps of the budget that were spent
  Evidence evidence;
};

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

/// Names that make_matcher() knows, the default first.
[[nodiscard]] const std::vector<std::string_view>& method_names();
/// Prepares the pair, which must outlive the matcher. Errc::kNotFound for an unknown method.
Result<std::unique_ptr<Matcher>> make_matcher(std::string_view method, const MapFeatures& a, const MapFeatures& b);

/// Steps that a match of any method never exceeds.
inline constexpr int kAmpleSteps = 100'000;

/// Standard deviations of a guess of which nothing else is known: 0.8 m and 6°, so that the window covers the book's
/// protocol (±2 m, ±15°).
[[nodiscard]] Matrix6 default_prior_covariance();

}  // namespace cairn::matching
