// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "fusion/peers/items/claim.hpp"

namespace cairn::team {

/// How a robot came by an edge. The upper two bits of the edge's index say it, so that all robots
/// can tell. The values are part of the peers' format.
enum class EdgeOrigin : std::uint8_t {
  kMatched = 0,   ///< two whole maps were compared
  kRefined = 1,   ///< two submaps were compared, from where the team's graph puts them
  kSurveyed = 2,  ///< not from maps: a survey, a marker that both robots saw
  kDeployed = 3,  ///< from where both robots say that they were put down
};

inline constexpr unsigned kOriginShift = 14;                          ///< bits of an index below its origin
inline constexpr std::uint16_t kEdgesPerOrigin = 1U << kOriginShift;  ///< indices of one origin

/// The index of a robot's nth edge of one origin, from 0; `nth` is below kEdgesPerOrigin.
[[nodiscard]] constexpr std::uint16_t edge_index(EdgeOrigin origin, std::size_t nth) {
  return static_cast<std::uint16_t>((static_cast<std::size_t>(origin) << kOriginShift) + nth);
}
[[nodiscard]] constexpr EdgeOrigin origin_of(std::uint16_t index) {
  return static_cast<EdgeOrigin>(index >> kOriginShift);
}

/// An edge to be published, and the index of its item.
struct IndexedEdge {
  std::uint16_t index = 0;
  peers::Edge edge;
};

}  // namespace cairn::team
