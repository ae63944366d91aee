// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Turns of a map (T_level_map, without translation) that may put its gravity along z: one for each of at most three
/// directions that many flat surfels face (either way), at least 45° apart. First that along which the map extends
/// least: buildings and streets are wider than high. Which way up is not decided: the end that had the larger z stays
/// above. The identity alone where nothing is flat.
[[nodiscard]] std::vector<SE3> levellings(std::span<const Surfel> surfels);

}  // namespace cairn::matching
