// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fusion/matching/features/plan_view.hpp"
#include "fusion/matching/search/global_search.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Poses T_a_b for placements on the plan: each placement at the two heights at which most surfaces
/// of the same kind meet. All heights at which the maps can meet are tried, wherever their frames
/// begin. `sample`: surfels of b, which vote.
[[nodiscard]] std::vector<SE3> stand_up(std::span<const Placement> placements, const PlanView& a, const PlanView& b,
                                        std::span<const Surfel> sample);

}  // namespace cairn::matching
