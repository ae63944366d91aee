// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/tile_store.hpp"

#include <utility>

namespace cairn::app {
namespace {

// A node of each container, and the two blocks of a tile, as the C library takes them.
constexpr std::size_t kOverhead = 48 + sizeof(TileStore::Tile) + 32 + 2 * 16;

std::size_t bytes_of(const TileStore::Tile& tile) {
  return kOverhead + tile.bytes.capacity() + sizeof(std::uint64_t) * tile.contributors.capacity();
}

}  // namespace

void TileStore::begin(std::uint32_t epoch) {
  if (epoch == epoch_) return;
  epoch_ = epoch;
  tiles_.clear();
  newest_.clear();
  bytes_ = 0;
}

bool TileStore::put(Tile tile) {
  const auto known = newest_.find(tile.key);
  if (known == newest_.end()) {
    if (tile.bytes.empty()) return true;
    if (bytes_ + bytes_of(tile) > most_bytes_) return false;
    tile.version = ++version_;
    bytes_ += bytes_of(tile);
    newest_.emplace(tile.key, version_);
    tiles_.emplace_hint(tiles_.end(), version_, std::move(tile));
    return true;
  }
  const auto place = tiles_.find(known->second);
  if (place->second.bytes == tile.bytes && place->second.contributors == tile.contributors) return true;
  auto node = tiles_.extract(place);
  bytes_ -= bytes_of(node.mapped());
  tile.version = known->second = node.key() = ++version_;
  bytes_ += bytes_of(tile);
  node.mapped() = std::move(tile);
  tiles_.insert(tiles_.end(), std::move(node));
  return true;
}

const TileStore::Tile* TileStore::next_after(std::uint64_t version) const {
  const auto next = tiles_.upper_bound(version);
  return next != tiles_.end() ? &next->second : nullptr;
}

}  // namespace cairn::app
