// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "fusion/matching/evidence/evidence.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// The relative pose of two maps, and the evidence for it.
struct MatchResult {
  /// Takes a point of map b to map a; the best so far if the budget ran out.
  UncertainPose T_a_b;
  double overlap = 0;       ///< ε of (4.21), 0…1
  double inlier_ratio = 0;  ///< of the pairs within the gate (4.20), 0…1
  double threshold = 0;     ///< the book's on the inlier ratio, for this overlap (4.21)
  /// Inlier_ratio is above threshold. For comparison: wrong poses often pass.
  bool book_accepted = false;
  bool accepted = false;           ///< decide()'s answer: use the pose only if it is true
  double probability_correct = 0;  ///< within 0.6 m and 6° of the truth
  std::string reason;              ///< why it was accepted or not, for people
  int iterations = 0;              ///< steps of the budget that were spent
  Evidence evidence;
};

}  // namespace cairn::matching
