// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fusion/matching/surfel_grid.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Turns of a map (T_level_map, without translation) that may put its gravity along z: for each direction that many
/// surfaces face, first the one along which the map extends least, as buildings and streets are wider than high. At
/// most three directions, at least 45° apart, unit length and each with z ≥ 0 of the map's frame turned upwards; the
/// identity alone where nothing is flat.
[[nodiscard]] std::vector<SE3> levellings(std::span<const Surfel> surfels);

}  // namespace cairn::matching
