// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_tiles.hpp"

#include <algorithm>
#include <vector>

#include "fusion/peers/tile_codec.hpp"

namespace cairn::peers {

bool OwnTiles::due(const Waiting& waiting, int times_said, Time now) const {
  if (times_said == 0) return now >= waiting.first + config_.first;
  Duration wait = config_.settled;
  for (int i = 1; i < times_said && wait < config_.longest; ++i) wait *= 2;
  wait = std::min(wait, config_.longest);
  return now >= waiting.last + wait || now >= waiting.first + config_.restless * wait;
}

void OwnTiles::say(Exchange& exchange, Time now) {
  if (now < next_round_) return;
  next_round_ = now + config_.round;
  const auto& said = exchange.layers().at(exchange.self()).holding.items();
  const bool quiet = now >= last_ + config_.quiet;
  std::vector<std::byte> payload;
  std::erase_if(waiting_, [&](const auto& entry) {
    const auto& [tile, waiting] = entry;
    const ItemId id = ItemId::tile(0, tile);
    int& times_said = times_said_[tile];
    if (!said.contains(id)) times_said = 0;  // never, or in an earlier epoch
    if (!quiet && !due(waiting, times_said, now)) return false;
    payload.clear();
    encode_tile(waiting.state, payload);
    times_said += exchange.say(id, payload) ? 1 : 0;
    return true;
  });
}

}  // namespace cairn::peers
