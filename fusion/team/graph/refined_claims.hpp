// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "fusion/merging/team_map.hpp"
#include "fusion/team/graph/pair_claim.hpp"
#include "fusion/team/graph/pose_graph.hpp"

namespace cairn::team {

using SubmapNodes = std::map<merging::SubmapKey, std::size_t>;  ///< of a pose graph

/// Which of the refined claims can be true: those within the 99.9 % bound of what is known without them, and, of two
/// about the same robots that odometry cannot both explain, the one that agrees with more others (pairwise consistency
/// over submaps that are near each other along both paths; where as many disagree with each, the one that is closer to
/// what is known without them). Others, and those about submaps that are not among the nodes, are not kept.
[[nodiscard]] std::vector<bool> agreeing_refinements(std::span<const PairClaim> claims, const SubmapChains& chains,
                                                     const Marginals& without, const SubmapNodes& nodes);

}  // namespace cairn::team
