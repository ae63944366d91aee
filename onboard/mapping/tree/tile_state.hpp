// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "onboard/mapping/tree/map_tile.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/mapping/tree/tile_voxels.hpp"

namespace cairn::mapping {

/// What a robot knows of the 512 voxels of a tile, in the coarse form that robots exchange:
/// unknown, free in two grades or occupied in four. Bit planes: element z, byte y, bit x.
struct TileState {
  static constexpr unsigned kEdge = 1U << TileKey::kVoxelBits;
  using Plane = std::array<std::uint64_t, kEdge>;

  Plane known{};
  Plane occupied{};  ///< known voxels only
  Plane low{};       ///< lower bit of the grade; grade 0 is the surest. Known voxels only
  Plane high{};      ///< upper bit; occupied voxels only
  /// Of occupied voxels, x fastest; empty where none has one, else of all 512 voxels, of not more
  /// than kMostLabels kinds.
  std::vector<VoxelLabel> labels{};
  static constexpr std::size_t kMostLabels = 16;  ///< kinds in a tile: an index of four bits

  /// Log-odds of the grades. −0.4 is OctoMap's miss, 3.5 its upper clamping value; the others lie
  /// between.
  static constexpr std::array<float, 2> kFree{-1.6F, -0.4F};
  static constexpr std::array<float, 4> kOccupied{3.5F, 2.5F, 1.5F, 0.5F};

  friend bool operator==(const TileState&, const TileState&) = default;

  [[nodiscard]] bool empty() const { return known == Plane{}; }
  [[nodiscard]] bool any_occupied() const { return occupied != Plane{}; }
  /// Whether the planes obey the rules above; to be asked of whatever comes from outside.
  [[nodiscard]] bool valid() const;

  /// Log-odds of a voxel, each coordinate 0…7; SemanticNode::kAbsent where it is unknown.
  [[nodiscard]] float log_odds(unsigned x, unsigned y, unsigned z) const {
    const unsigned at = kEdge * y + x;
    const auto bit = [at, z](const Plane& plane) { return static_cast<unsigned>(plane[z] >> at & 1U); };
    if (bit(known) == 0) return SemanticNode::kAbsent;
    const unsigned grade = bit(low) | bit(high) << 1;
    return bit(occupied) != 0 ? kOccupied[grade] : kFree[grade];
  }
  [[nodiscard]] VoxelLabel label(unsigned x, unsigned y, unsigned z) const {
    return labels.empty() ? VoxelLabel{} : labels[x + kEdge * (y + kEdge * z)];
  }
  /// Of labels of occupied voxels, x fastest; of more than kMostLabels kinds the rarest are left
  /// out.
  void set_labels(std::vector<VoxelLabel> of_voxels);
  /// The nearest grade; a value from `threshold` on is occupied. Labels stay as they are.
  void set(unsigned x, unsigned y, unsigned z, float log_odds, float threshold = 0);
};

/// Of one tile of a map; empty where the map knows nothing.
[[nodiscard]] TileState read_tile(const SemanticOcTree& map, TileKey tile);

/// Makes one tile of the map what `state` says, to the log-odds of its grades; the map stays
/// canonical. An empty state removes the tile.
void write_tile(SemanticOcTree& map, TileKey tile, const TileState& state);

/// The same for any log-odds; `labels` null: none.
void write_tile(SemanticOcTree& map, TileKey tile, const TileVoxels& voxels, const TileLabels* labels = nullptr);

/// Adds to one tile of the map what `other`, a map of the same grid and resolution, knows of voxels of which the map
/// knows nothing. Voxels that the map knows stay as they are. The map stays canonical. True: the tile has changed.
bool fill_tile(SemanticOcTree& map, TileKey tile, const SemanticOcTree& other);

/// Every tile in which the map knows something, in canonical order; not more than `most`.
[[nodiscard]] std::vector<TileKey> known_tiles(const SemanticOcTree& map, std::size_t most);

}  // namespace cairn::mapping
