// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fusion/matching/features/plan_view.hpp"
#include "hal/budget.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// A pose of one plan in the other: the middle of b's walls is at (x, y) of a's frame.
struct Placement {
  double yaw_rad, x_m, y_m;
  float score;
};

/// Where b's plan may lie in a's, best first (by a weak and by a strong weight of free space in turn), whatever the
/// heading and distance: for every 3° of heading, walls are correlated with walls, the ways they face with each other,
/// and walls against the other's free space, for all shifts at once by Fourier transforms. Headings under which the
/// walls' directions do not agree are left out. Each heading is a step of the budget. At most `most` placements, 0.8 m
/// or 4.5° apart.
[[nodiscard]] std::vector<Placement> sweep(const PlanView& a, const PlanView& b, std::size_t most, Budget& budget);

/// The same in three dimensions: each placement at the two heights at which most surfaces of the same kind meet.
/// `sample` is of b's surfels.
[[nodiscard]] std::vector<SE3> stand_up(std::span<const Placement> placements, const PlanView& a, const PlanView& b,
                                        std::span<const Surfel> sample);

}  // namespace cairn::matching
