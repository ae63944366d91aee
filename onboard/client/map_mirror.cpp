// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/map_mirror.hpp"

#include <utility>

#include "fusion/peers/items/tile_codec.hpp"

namespace cairn::client {

MapMirror::MapMirror(clients::TileMap map, double resolution_m) : which_(map), tree_(resolution_m) {}

Result<void> MapMirror::take(const clients::TilesMessage& message) {
  if (message.map != which_) return {};
  if (message.session != has_.session || message.epoch != has_.epoch) begin(message);
  caught_up_ = false;
  for (const clients::TilesMessage::Tile& tile : message.tiles) {
    if (tile.version <= has_.version) continue;  // it is here already
    if (const auto taken = take(tile); !taken) return taken;
    has_.version = tile.version;
  }
  caught_up_ = message.caught_up;
  return {};
}

void MapMirror::begin(const clients::TilesMessage& message) {
  has_ = {.session = message.session, .epoch = message.epoch, .version = 0};
  tree_.clear();
  origins_.clear();
  changes_ = {.anew = true, .tiles = {}};
}

Result<void> MapMirror::take(const clients::TilesMessage::Tile& tile) {
  mapping::TileState state;
  if (!tile.bytes.empty()) {
    auto decoded = peers::decode_tile(tile.bytes);
    if (!decoded) return decoded.error();
    state = std::move(*decoded);
  }
  const mapping::TileKey key{tile.key};
  mapping::write_tile(tree_, key, state);
  if (state.empty())
    origins_.erase(tile.key);
  else
    origins_[tile.key] = {.robots = tile.contributors, .changed = tile.changed};
  changes_.tiles.push_back(key);
  return {};
}

const MapMirror::Origin* MapMirror::origin_of(mapping::TileKey tile) const {
  const auto found = origins_.find(tile.morton);
  return found != origins_.end() ? &found->second : nullptr;
}

MapMirror::Changes MapMirror::take_changes() { return std::exchange(changes_, {}); }

}  // namespace cairn::client
