// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_tiles.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "fusion/peers/items/tile_codec.hpp"

namespace cairn::peers {

double change_between(const mapping::TileState& said, const mapping::TileState& now) {
  const auto differing = [](const mapping::TileState::Plane& a, const mapping::TileState::Plane& b) {
    int voxels = 0;
    for (unsigned z = 0; z < mapping::TileState::kEdge; ++z) voxels += std::popcount(a[z] ^ b[z]);
    return voxels;
  };
  int labels = 0;
  for (unsigned z = 0; z < mapping::TileState::kEdge && !(said.labels.empty() && now.labels.empty()); ++z)
    for (unsigned y = 0; y < mapping::TileState::kEdge; ++y)
      for (unsigned x = 0; x < mapping::TileState::kEdge; ++x)
        labels += said.label(x, y, z) != now.label(x, y, z) ? 1 : 0;
  return labels + differing(said.known, now.known) + differing(said.occupied, now.occupied) +
         0.25 * (differing(said.low, now.low) + differing(said.high, now.high));
}

SeenAgain OwnTiles::observe(mapping::TileKey tile, const mapping::TileState& state, Time now, std::uint16_t submap) {
  SeenAgain seen;
  auto [waiting, added] = waiting_.try_emplace(tile);
  if (!added)
    seen = seen_again(waiting->second.state, state);
  else if (const auto said = said_.find(tile); said != said_.end())
    seen = seen_again(said->second.state, state);
  if (added) waiting->second.first = now;
  waiting->second.state = state;
  waiting->second.submap = submap;
  waiting->second.last = last_ = now;
  return seen;
}

std::size_t OwnTiles::forget(Time since) {
  return std::erase_if(waiting_, [&](const auto& entry) { return entry.second.last >= since; });
}

bool OwnTiles::due(const Waiting& waiting, const Said* said, Time now) const {
  if (said == nullptr) return now >= waiting.first + config_.first;
  const double much = said->again ? config_.much : config_.much_first;
  const double times = std::max(1.0, much / std::max(1.0, change_between(said->state, waiting.state)));
  const Duration wait = std::min(config_.longest, from_seconds(times * to_seconds(config_.settled)));
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
    const auto last = said_.find(tile);
    const bool again = last != said_.end() && said.contains(ItemId::tile(last->second.submap, tile));
    if (again && last->second.state == waiting.state) return true;  // as peers know it, whatever the submap
    if (!quiet && !due(waiting, again ? &last->second : nullptr, now)) return false;
    payload.clear();
    encode_tile(waiting.state, payload);
    exchange.say(ItemId::tile(waiting.submap, tile), payload);
    said_[tile] = {waiting.state, waiting.submap, again};
    return true;
  });
}

}  // namespace cairn::peers
