// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>

#include "drivers/clients/messages/tiles.hpp"

namespace cairn::app {

/// The newest state of every tile of one map, in the order of its last change. Pure. Versions count up through all
/// epochs, so a client that says how far it has come gets exactly what is newer.
class TileStore {
 public:
  using Tile = clients::TilesMessage::Tile;
  /// Of tiles, all overhead included. A tile takes some 300 bytes, so it holds about 800 000.
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20U;

  explicit TileStore(std::size_t most_bytes = kMostBytes) : most_bytes_(most_bytes) {}

  /// The map of this epoch begins. Nothing happens if it is the present one.
  void begin(std::uint32_t epoch);
  /// Takes the state of a tile, whose version does not matter. Empty bytes: nothing is known of it any more. If bytes
  /// and contributors are as before, it has not changed. False: a new tile finds no memory; it is left out.
  bool put(Tile tile);

  /// The first tile with a higher version than `version`; null: there is none.
  [[nodiscard]] const Tile* next_after(std::uint64_t version) const;
  /// Of the last change, ever; 0: there was none.
  [[nodiscard]] std::uint64_t version() const { return version_; }
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }
  [[nodiscard]] std::size_t size() const { return tiles_.size(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::size_t most_bytes_;
  std::uint32_t epoch_ = 0;
  std::uint64_t version_ = 0;
  std::size_t bytes_ = 0;
  std::map<std::uint64_t, Tile> tiles_;                      // by version
  std::unordered_map<std::uint64_t, std::uint64_t> newest_;  // by key: version
};

}  // namespace cairn::app
