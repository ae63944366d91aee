// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/placement.hpp"

#include <algorithm>
#include <cmath>

#include "fusion/matching/search/same_place.hpp"

namespace cairn::matching {

std::vector<Placement> different_places(std::vector<Placement> all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(), [](const auto& p, const auto& q) { return p.score > q.score; });
  std::vector<Placement> kept;
  for (const Placement& p : all) {
    if (kept.size() == most) break;
    const bool near = std::any_of(kept.begin(), kept.end(), [&](const Placement& k) {
      return same_place(std::hypot(p.x_m - k.x_m, p.y_m - k.y_m),
                        std::abs(std::remainder(p.yaw_rad - k.yaw_rad, 2 * M_PI)));
    });
    if (!near) kept.push_back(p);
  }
  return kept;
}

}  // namespace cairn::matching
