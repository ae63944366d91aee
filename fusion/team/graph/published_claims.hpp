// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "fusion/peers/exchange.hpp"
#include "fusion/team/graph/pair_claim.hpp"

namespace cairn::team {

/// Of one robot's edges of one origin, only the first so many count: each is weighed against all
/// others, and a faulty robot may publish thousands.
inline constexpr std::size_t kMostClaimsPerOrigin = 256;

/// The edges that all robots have published, in the order of the robots and of the edges' indices.
/// These are left out:
/// - withdrawn ones, whose probability is 0;
/// - those about an earlier beginning of the other robot;
/// - those whose covariance is singular, which would make the equations of all unsolvable.
[[nodiscard]] std::vector<PairClaim> published_claims(const peers::Layers& layers);

/// Where the robots' submaps lie by their own odometry. Each chain ends before the first submap that
/// is missing or has a singular covariance. A robot without a chain is not in the result.
[[nodiscard]] SubmapChains published_chains(const peers::Layers& layers);

}  // namespace cairn::team
