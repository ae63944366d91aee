// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "fusion/matching/evidence/evidence.hpp"

namespace cairn::matching {

/// Settings of decide().
struct AcceptanceConfig {
  /// Of an accepted match. None of the 9 700 wrong looks of the fit below reaches it: the highest
  /// has 0.93.
  double least_probability = 0.95;
  /// Sampled structure that must agree. Doubled from 60 on tests/bench/matching_missions.
  int least_structure_pairs = 120;
  /// Least Evidence::weakest_translation. Below it, no surface holds one direction: an endless
  /// corridor has less than 0.02 (tests/fusion/matching/evidence), a lobby more than 0.05.
  double least_weakest_translation = 0.02;
};

/// The answer to one comparison.
struct Decision {
  bool accepted = false;
  double probability_correct = 0;  ///< within 0.6 m and 6° of the truth
  std::string reason;              ///< why it was accepted or not, for people
};

/// Decides on the evidence of one comparison. It is accepted if it is probably right, enough
/// structure agrees, and each direction is held by some surface.
///
/// The probability is logistic in the evidence. It was fitted by maximum likelihood on:
/// - 13 300 looks at growing maps of 0.1 and 0.2 m (tests/bench/matching_missions, seeds 100 to
///   106, all kinds of random buildings). Half-turned ones, whose copies nothing gives away, count
///   a fifth.
/// - 800 looks on recordings with odometry (tests/bench/team_runs, looks=1).
///
/// Of right looks, 47 to 96 % get 0.9 or more, by the kind of building. Of wrong ones, one in 9 700
/// does (0.93), where no half of a building is a copy of the other. Expected calibration errors are
/// 0.013 to 0.040 for each kind. Copied geometry can look perfect to any test of one comparison:
/// see PendingHypotheses.
[[nodiscard]] Decision decide(const Evidence& evidence, const AcceptanceConfig& config = {});

}  // namespace cairn::matching
