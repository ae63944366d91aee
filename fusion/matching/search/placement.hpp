// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace cairn::matching {

/// A pose of one plan in the other: the middle of b's walls is at (x, y) of a's frame.
struct Placement {
  double yaw_rad = 0, x_m = 0, y_m = 0;
  float score = 0;  ///< no unit; for ranking
};

/// The best `most` placements that are different places (see same_place()), best first.
[[nodiscard]] std::vector<Placement> different_places(std::vector<Placement> all, std::size_t most);

}  // namespace cairn::matching
