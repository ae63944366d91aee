// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace cairn::cli {

/// A body in view of a detector.
struct LookedAt {
  bool person = false;  ///< in truth
  bool boxed = false;   ///< a box of a person belongs to it
  double score = 0;     ///< of the box, 0 to 1
};

/// What a detector said of bodies whose truth is known, and how far it can be trusted: the keys of
/// `perception.people.visible` and `thermal` of a profile.
struct DetectorFit {
  static constexpr std::size_t kBins = 10;  ///< of the score, 0.1 wide
  struct Bin {
    std::uint64_t people = 0, others = 0;  ///< boxes
  };
  std::uint64_t people = 0, others = 0;              ///< bodies
  std::uint64_t people_boxed = 0, others_boxed = 0;  ///< of them
  std::array<Bin, kBins> boxes{};

  double recall = 0, false_share = 0;  ///< shares of the bodies, with one more of each kind (Laplace)
  /// How the log odds of a box change with its score: logistic regression with the targets of Platt (1999). 0 where
  /// fewer than kFewestBoxes boxes of either kind are there, or where a larger score says less.
  double score_slope = 0, slope_sigma = 0;
  /// The score at which that line is ln(recall / false_share); with a slope of 0 the mean score of people's boxes.
  double usual_score = 0;
};

inline constexpr std::uint64_t kFewestBodies = 20;  ///< of each kind
inline constexpr std::uint64_t kFewestBoxes = 5;    ///< of each kind, for a slope

/// None: fewer than kFewestBodies of either kind, or no box at a person.
[[nodiscard]] std::optional<DetectorFit> fit_detector(std::span<const LookedAt> bodies);

}  // namespace cairn::cli
