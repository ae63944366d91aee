// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fusion/matching/features/map_features.hpp"
#include "hal/budget.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Settings of check_submaps(). tests/bench/map_check measures false alarms, and which slips are
/// found.
struct MapCheckConfig {
  /// Standard deviations of odometry's error between two submaps.
  double bend_m = 0.03, bend_rad = 0.004;
  double most_conflict = 0.06;  ///< share of structure in the other submap's free space
  /// Samples of each submap's structure, at most.
  std::size_t samples = 1500;
  /// Of these samples, those that meet structure of the other submap, at least. A pair with less is left
  /// out.
  int least_in_common = 120;
};

/// One pair of submaps of one robot.
struct SubmapPair {
  std::size_t first = 0, second = 0;  ///< indices
  /// Moves the second so that both agree, in their common frame.
  UncertainPose slip;
  /// Slip against its covariance and odometry's error; χ² with 6 degrees of freedom.
  double chi2 = 0;
  /// Share of structure in the other's free space, both ways, as the submaps lie.
  double conflict = 0;
  bool consistent = true;
  std::string reason;  ///< for people
};

/// Checks whether a robot's map is of one piece, before it is shared. `submaps` are parts of it,
/// made one after the other in one frame and at one resolution. They must agree as they lie
/// wherever they overlap. If two do not, a pose slipped in between. A pair is inconsistent if its
/// slip is beyond the 99.9 % bound of its χ², or if too much structure stands in the other's free
/// space. Pairs with too little in common are left out. Each pair is a step of the budget.
[[nodiscard]] std::vector<SubmapPair> check_submaps(std::span<const MapFeatures* const> submaps, Budget& budget,
                                                    const MapCheckConfig& config = {});

}  // namespace cairn::matching
