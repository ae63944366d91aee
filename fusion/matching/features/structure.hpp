// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fusion/matching/features/surfel_grid.hpp"

namespace cairn::matching {

/// The surfels that are structure, in their order; see Surfel::structure().
[[nodiscard]] std::vector<Surfel> structure_of(std::span<const Surfel> surfels);

}  // namespace cairn::matching
