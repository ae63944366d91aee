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

/// Whether the evidence of one comparison suffices. The probability is logistic in the evidence; on top of it there are
/// gates, because copied geometry can look perfect: enough agreeing structure,
/// and no direction that nothing holds.
[[nodiscard]] Decision decide(const Evidence& evidence);

}  // namespace cairn::matching
