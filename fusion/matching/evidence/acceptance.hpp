// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "fusion/matching/evidence/evidence.hpp"

namespace cairn::matching {

struct Decision {
  bool accepted = false;
  double probability_correct = 0;
  std::string reason;
};

/// Whether the evidence of one comparison suffices: a probability of at least 0.95, enough agreeing structure, and no
/// direction that nothing holds. The probability is logistic in the evidence, fitted by maximum likelihood on 13 300
/// different looks at growing maps of 0.1 and 0.2 m (tests/bench/matching_missions, seeds 100 to 106, all kinds of
/// random buildings; half-turned ones, whose copies nothing gives away, count a fifth) and 800 on recordings with
/// odometry (tests/bench/team_runs, looks=1). Of right looks it gives 47 to 96 % 0.9 or more, of wrong ones, where no
/// half of a building is a copy, one in 9 700 (0.93); expected calibration errors are 0.013 to 0.040 for each kind.
/// Copied geometry can look perfect to any test of one comparison: see PendingHypotheses.
[[nodiscard]] Decision decide(const Evidence& evidence);

}  // namespace cairn::matching
