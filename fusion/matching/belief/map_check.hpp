// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fusion/matching/features/map_features.hpp"
#include "hal/budget.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// What two submaps of one robot say of each other.
struct SubmapPair {
  std::size_t first = 0, second = 0;
  UncertainPose slip;   ///< where the second would have to be moved for the two to agree, in their common frame
  double chi2 = 0;      ///< slip against its covariance and what odometry may bend; χ² with 6 degrees of freedom
  double conflict = 0;  ///< share of structure that stands in space which the other saw free, both ways, as they lie
  bool consistent = true;
  std::string reason;
};

/// Whether a robot's map is of one piece, before it is shared: parts of it that were made one after the other, in one
/// frame and at one resolution, must agree where they overlap as they lie. Two that do not were made with a pose that
/// slipped in between. Inconsistent is a slip beyond the 99.9 % bound of its χ², or more than 6 % of structure in the
/// other's free space. Pairs with too little in common are left out; each pair that is compared is a step of the
/// budget. tests/bench/map_check measures false alarms and what slips are found.
[[nodiscard]] std::vector<SubmapPair> check_submaps(std::span<const MapFeatures* const> submaps, Budget& budget);

}  // namespace cairn::matching
