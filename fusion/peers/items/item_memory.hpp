// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "fusion/peers/items/item.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::peers {

/// Blocks of eight nodes that a tree needs for a tile at most: equal neighbours share one node.
[[nodiscard]] std::size_t blocks_of(const TileState& state);

/// What it takes to keep an item: its payload, the decoded tile, and its share of two maps (the one that is shown and
/// the one that is being built). A payload that cannot be read costs as much as its bytes.
[[nodiscard]] std::size_t memory_of(ItemId id, std::span<const std::byte> payload);

}  // namespace cairn::peers
