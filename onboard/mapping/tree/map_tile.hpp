// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace cairn::mapping {

/// A cube of 8×8×8 voxels: a node at depth 13 of the tree. Tiles are what robots exchange.
struct TileKey {
  static constexpr unsigned kVoxelBits = 3;  ///< voxel key >> 3 = tile coordinate

  /// Path from the root: three bits per level (x lowest), the first level in the highest bits. Its order is the
  /// depth-first order of the tree, and the canonical order of tiles.
  std::uint64_t morton = 0;

  /// From the key of any voxel in the tile.
  [[nodiscard]] static constexpr TileKey of_voxel(std::uint16_t x, std::uint16_t y, std::uint16_t z) {
    std::uint64_t code = 0;
    for (unsigned bit = kVoxelBits; bit < 16; ++bit) {
      const std::uint64_t digit = ((x >> bit) & 1U) | ((y >> bit) & 1U) << 1 | ((z >> bit) & 1U) << 2;
      code |= digit << (3 * (bit - kVoxelBits));
    }
    return {code};
  }
  /// Lowest voxel key of the tile along an axis (0 = x).
  [[nodiscard]] constexpr std::uint16_t first_voxel(unsigned axis) const {
    unsigned key = 0;
    for (unsigned bit = kVoxelBits; bit < 16; ++bit)
      key |= static_cast<unsigned>((morton >> (3 * (bit - kVoxelBits) + axis)) & 1U) << bit;
    return static_cast<std::uint16_t>(key);
  }

  friend constexpr auto operator<=>(const TileKey&, const TileKey&) = default;
};

}  // namespace cairn::mapping
