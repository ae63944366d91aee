// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "fusion/matching/evidence/evidence.hpp"
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

}  // namespace cairn::matching
