// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_tiles.hpp"

#include <vector>

#include "fusion/peers/tile_codec.hpp"

namespace cairn::peers {

void OwnTiles::say(Exchange& exchange, Time now) {
  const auto& said = exchange.layers().at(exchange.self()).holding.items();
  std::vector<std::byte> payload;
  std::erase_if(waiting_, [&](const auto& entry) {
    const auto& [tile, waiting] = entry;
    const ItemId id = ItemId::tile(0, tile);
    const bool due = said.contains(id)
                         ? now >= waiting.last + config_.settled || now >= waiting.first + config_.restless
                         : now >= waiting.first + config_.first;
    if (!due) return false;
    payload.clear();
    encode_tile(waiting.state, payload);
    exchange.say(id, payload);
    return true;
  });
}

}  // namespace cairn::peers
