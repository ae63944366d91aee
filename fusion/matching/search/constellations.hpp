// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fusion/matching/features/landmarks.hpp"
#include "fusion/matching/search/placement.hpp"
#include "hal/budget.hpp"

namespace cairn::matching {

/// Settings of constellations().
struct ConstellationConfig {
  /// Of each map: the strongest ones. A bound on time; halls and outdoor places of 80 m had 16 to 83.
  std::size_t landmarks = 300;
  /// Pairs of landmarks of one map, at most: those of the strongest landmarks. A bound on time.
  std::size_t pairs = 6000;
  std::size_t placements = 100;  ///< that are kept; chosen by hand
};

/// Places b's plan in a's by two landmarks of b that are as far apart as two of a. Such a placement is
/// the better, the more of b's landmarks then lie on landmarks of a that are alike. This needs few
/// landmarks in common, at any distance and heading. So it finds small overlaps of large maps, which
/// sweep() does not see in its pixels. Best first; different places (see same_place()). `middle_b`: of
/// b's walls, m. Each landmark of b is one step of the budget.
[[nodiscard]] std::vector<Placement> constellations(std::span<const Landmark> a, std::span<const Landmark> b,
                                                    const Eigen::Vector2f& middle_b, const ConstellationConfig& config,
                                                    Budget& budget);

}  // namespace cairn::matching
