// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/item_memory.hpp"

#include <bit>
#include <cstdint>
#include <vector>

#include "fusion/peers/items/tile_codec.hpp"

namespace cairn::peers {
namespace {

constexpr std::size_t kBlockBytes = 128, kInnerBlocks = 8 + 1;  // see NodePool; the two levels above the voxels' blocks
constexpr std::size_t kItemBytes = 192;                         // two nodes of a map, a block of the heap
constexpr std::size_t kTileBytes = sizeof(mapping::TileState) + 192;  // likewise, a stamp, and which submap it is in
constexpr std::size_t kMaps = 2;

/// One bit of each voxel's label.
mapping::TileState::Plane label_bit(const mapping::TileState& state, unsigned bit) {
  mapping::TileState::Plane plane{};
  for (std::size_t i = 0; i < state.labels.size(); ++i)
    plane[i / 64] |= std::uint64_t{state.labels[i].code >> bit & 1U} << (i % 64);
  return plane;
}

/// Of 16 cubes of 2³ voxels in two layers, a bit for each that differs within itself on this plane.
std::uint64_t uneven(std::uint64_t lower, std::uint64_t upper) {
  constexpr std::uint64_t kEvenX = 0x5555'5555'5555'5555, kEvenRows = 0x00FF'00FF'00FF'00FF;
  const std::uint64_t along_x = (lower ^ lower >> 1U) & kEvenX, along_y = (lower ^ lower >> 8U) & kEvenRows;
  const std::uint64_t differs = (lower ^ upper) | along_x | along_y;
  const std::uint64_t rows = differs | differs >> 1U;
  return (rows | rows >> 8U) & kEvenX & kEvenRows;
}

}  // namespace

std::size_t blocks_of(const mapping::TileState& state) {
  std::vector<mapping::TileState::Plane> labels;
  for (unsigned bit = 0; bit < 7 && !state.labels.empty(); ++bit) labels.push_back(label_bit(state, bit));
  std::size_t cubes = 0;
  for (std::size_t z = 0; z < mapping::TileState::kEdge; z += 2) {
    std::uint64_t differs = 0;
    for (const mapping::TileState::Plane* plane : {&state.known, &state.occupied, &state.low, &state.high})
      differs |= uneven((*plane)[z], (*plane)[z + 1]);
    for (const mapping::TileState::Plane& plane : labels) differs |= uneven(plane[z], plane[z + 1]);
    cubes += static_cast<std::size_t>(std::popcount(differs));
  }
  return cubes + kInnerBlocks;
}

std::size_t memory_of(ItemId id, std::span<const std::byte> payload) {
  const std::size_t kept = payload.size() + kItemBytes;
  if (id.kind() != ItemKind::kTile) return kept;
  const auto state = decode_tile(payload);
  return state ? kept + kTileBytes + state->labels.size() + kMaps * kBlockBytes * blocks_of(*state) : kept;
}

}  // namespace cairn::peers
