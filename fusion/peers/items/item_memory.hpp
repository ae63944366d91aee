// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "fusion/peers/items/item.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::peers {

/// The most blocks of eight nodes that a tree needs for a tile. Equal neighbours share one node.
[[nodiscard]] std::size_t blocks_of(const mapping::TileState& state);

/// Bytes that an item takes: its payload, the decoded tile, and its share of two maps (the map that is shown and the
/// map that is being built). A payload that cannot be decoded takes its own bytes.
[[nodiscard]] std::size_t memory_of(ItemId id, std::span<const std::byte> payload);

}  // namespace cairn::peers
