// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "fusion/matching/evidence.hpp"

namespace cairn::matching {

struct Decision {
  bool accepted = false;
  double probability_correct = 0;
  std::string reason;
};

/// Whether the evidence of one comparison suffices: a probability of at least 0.95, enough agreeing structure, and no
/// direction that nothing holds. The probability is logistic in the evidence, fitted by maximum likelihood on 1104
/// matches of tests/bench/matching_evidence (seeds 101 to 106; 935 of the answers wrong). There it accepts 125 of the
/// 169 right ones and one wrong one, in a corridor that looks the same from either end; the book's test accepts 212
/// wrong ones. Fitted on the first two thirds, it accepts 43 of 57 right ones and none of 311 wrong ones in the last
/// third, with an expected calibration error of 0.025. Copied geometry can look perfect to any test of one comparison.
[[nodiscard]] Decision decide(const Evidence& evidence);

}  // namespace cairn::matching
