// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/clients/messages/tiles.hpp"
#include "onboard/app/streams/client_hub.hpp"
#include "onboard/app/streams/outlets/tile_outlet.hpp"
#include "onboard/app/streams/tile_store.hpp"

namespace cairn::app {

/// The tiles of one map on their way to the clients that want them. A client that does not read misses nothing: it goes
/// on where it was, with the newest state of what has changed since.
class TileStream {
 public:
  /// `self`: the robot that has seen all tiles; 0: each tile says who has.
  TileStream(clients::TileMap map, std::uint64_t session, std::uint64_t self)
      : map_(map), session_(session), self_(self) {}

  /// Takes what the outlet holds, `most` tiles at most. False: a new tile finds no memory.
  bool take(TileOutlet& outlet, std::size_t most);
  /// A client has subscribed: it gets what it lacks.
  void begin(StreamClient& client) const;
  /// Sends what clients lack while their sockets take it, in at most `records` records for all of them. Clients take
  /// turns. Returns how many were sent.
  std::size_t serve(ClientHub& hub, Time now, std::size_t records);
  /// Clients that did not take a record are tried again at once.
  void try_again(ClientHub& hub) const;
  /// Every client that wants the map has all of it.
  [[nodiscard]] bool all_caught_up(ClientHub& hub) const;

  [[nodiscard]] const TileStore& store() const { return store_; }

 private:
  [[nodiscard]] bool wants(const StreamClient& client) const;
  [[nodiscard]] TileCursor& cursor_of(StreamClient& client) const {
    return client.tiles[static_cast<std::size_t>(map_)];
  }
  [[nodiscard]] bool up_to_date(const TileCursor& cursor) const;
  bool serve_one(ClientHub& hub, StreamClient& client, Time now);

  clients::TileMap map_;
  std::uint64_t session_, self_;
  TileStore store_;
  bool more_ = false;  // the outlet has more
  std::size_t turn_ = 0;
  std::vector<std::byte> record_;  // reused
};

}  // namespace cairn::app
