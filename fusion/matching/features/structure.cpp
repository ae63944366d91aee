// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/structure.hpp"

#include <algorithm>
#include <iterator>

namespace cairn::matching {

std::vector<Surfel> structure_of(std::span<const Surfel> surfels) {
  std::vector<Surfel> out;
  std::copy_if(surfels.begin(), surfels.end(), std::back_inserter(out), [](const Surfel& s) { return s.structure(); });
  return out;
}

}  // namespace cairn::matching
