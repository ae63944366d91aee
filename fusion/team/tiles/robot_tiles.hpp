// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "hal/se3.hpp"
#include "onboard/mapping/tree/map_tile.hpp"

namespace cairn::team {

/// Which tiles a robot has said in which submap, and which of them hold something occupied.
class RobotTiles {
 public:
  using Tiles = std::set<mapping::TileKey>;

  /// The submap that the tile was in until now, where that is another one.
  std::optional<std::uint16_t> put(mapping::TileKey tile, std::uint16_t submap, bool occupied);

  /// How many tiles hold something occupied.
  [[nodiscard]] std::size_t walls() const { return count_; }
  [[nodiscard]] Tiles all_walls() const;
  /// Those, by submap.
  [[nodiscard]] const std::map<std::uint16_t, Tiles>& walls_by_submap() const { return walls_; }

 private:
  std::map<mapping::TileKey, std::uint16_t> submap_of_;
  std::map<std::uint16_t, Tiles> walls_;
  std::size_t count_ = 0;
};

/// How many of a's tiles have their centre in one of b's; T_b_a takes a's grid to b's, whose tiles have the same edge.
[[nodiscard]] std::size_t common_tiles(const RobotTiles::Tiles& a, const RobotTiles::Tiles& b, const SE3& T_b_a,
                                       double tile_m);

}  // namespace cairn::team
