// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/detector_trust.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::people {

double DetectorTrust::of_box(double score) const {
  return std::clamp(std::log(recall / false_share) + score_slope * (score - usual_score), 0.0, kMostOfABox);
}

double DetectorTrust::of_silence(double distance_m) const {
  const double share = distance_m / farthest_m, here = recall * (1 - share * share);
  return here > false_share ? std::log((1 - here) / (1 - false_share)) : 0;
}

}  // namespace cairn::people
