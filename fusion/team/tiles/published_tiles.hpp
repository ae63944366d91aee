// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fusion/peers/items/holding.hpp"
#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::team {

/// A copy of a robot's tiles as they were published. It is small enough to be handed to another
/// thread, which makes a map of it.
struct PublishedTiles {
  /// One tile: its place, its submap, and where its bytes are.
  struct Tile {
    mapping::TileKey key;
    std::uint16_t submap = 0;
    std::size_t begin = 0, bytes = 0;  ///< in `payloads`
  };
  double resolution_m = 0;    ///< edge of a voxel
  std::vector<Tile> tiles{};  ///< in the order of their keys
  std::vector<std::byte> payloads{};
  /// Where odom lies in the map, as far as the tiles of a submap go. A submap that is not in it: the
  /// map's frame is odom.
  std::map<std::uint16_t, SE3> T_map_odom{};

  /// All tiles of what one robot has published, or those of one submap. In odom.
  [[nodiscard]] static PublishedTiles of(const peers::Holding& holding, double resolution_m,
                                         std::optional<std::uint16_t> submap = {});

  [[nodiscard]] SE3 T_map_odom_of(std::uint16_t submap) const;
  /// The map that the tiles make. Tiles that cannot be decoded are left out.
  [[nodiscard]] mapping::SemanticOcTree map() const;
};

}  // namespace cairn::team
