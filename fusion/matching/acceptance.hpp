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
/// matches of tests/bench/matching_evidence (seeds 101 to 106; 935 of the answers wrong) and 2484 looks at growing maps
/// (tests/bench/matching_missions, seeds below 1000, with and without copied rooms; 2277 wrong). Fitted on two thirds
/// of the first and half of the second, it gives 103 of 157 right answers of the rest 0.95 or more and no wrong one
/// above 0.75, with expected calibration errors of 0.023 (matches), 0.011 (looks) and 0.026 (looks at copied rooms).
/// Copied geometry can look perfect to any test of one comparison: see PendingHypotheses.
[[nodiscard]] Decision decide(const Evidence& evidence);

}  // namespace cairn::matching
