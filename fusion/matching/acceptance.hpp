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

/// Whether the evidence of one comparison suffices: a probability of at least 0.9, enough agreeing structure, and no
/// direction that nothing holds. The probability is logistic in the evidence, fitted by maximum likelihood on 2016
/// matches of tests/bench/matching_evidence (seeds 101 to 112). On 1344 others (seeds 1 to 8: other rides, ranges, cuts
/// and starts in the same scenes, 1166 of the answers wrong) none was accepted wrongly and 68 % of the right ones were
/// accepted, most others having an overlap below 0.3; the book's test accepted 340 wrong ones there. Copied geometry
/// can look perfect to any test of one comparison.
[[nodiscard]] Decision decide(const Evidence& evidence);

}  // namespace cairn::matching
