// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Turns of a map (T_level_map, without translation) that may bring its gravity along z.
/// There is one for each direction that many flat surfels face: at most three, at least 45° apart.
/// The direction in which the map extends least comes first: buildings are wider than high.
/// It is not decided which way up the map is: the end with the larger z stays above.
/// Gives the identity alone where nothing is flat.
[[nodiscard]] std::vector<SE3> levellings(std::span<const Surfel> surfels);

/// The turn of a map (T_level_map, without translation) whose z is upwards within some degrees. It brings flat pieces
/// of 2 m that are nearly upright or level as near to that as it can. Walls weigh ten times as much as floors, because
/// ground slopes. Gives the identity for a lean of less than 0.5°, and where little is flat.
[[nodiscard]] SE3 straightening(std::span<const Surfel> surfels);

/// The surfels, turned.
[[nodiscard]] std::vector<Surfel> turned(std::span<const Surfel> surfels, const SE3& turn);

}  // namespace cairn::matching
