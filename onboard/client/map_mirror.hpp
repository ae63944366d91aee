// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "drivers/clients/messages/subscribe.hpp"
#include "drivers/clients/messages/tiles.hpp"
#include "hal/result.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::client {

/// A copy of a running core's map, kept up to date from its records of tiles. Log-odds are those of a tile's grades,
/// see mapping::TileState.
class MapMirror {
 public:
  /// `resolution_m`: of the core's greeting.
  MapMirror(clients::TileMap map, double resolution_m);

  /// Takes in a record; one of the other map is left alone. A record of another session or epoch begins the map anew.
  /// Error kMalformed: a tile is not what it should be. It and those after it are left out, and resume() asks for them
  /// again.
  Result<void> take(const clients::TilesMessage& message);

  /// For the next subscription: what this mirror has.
  [[nodiscard]] const clients::SubscribeMessage::Resume& resume() const { return has_; }
  /// The mirror had everything when its last record came.
  [[nodiscard]] bool caught_up() const { return caught_up_; }

  [[nodiscard]] const mapping::SemanticOcTree& map() const { return tree_; }
  /// Who knows something of a tile.
  struct Origin {
    std::vector<std::uint64_t> robots;  ///< ids, ascending; empty: this robot, which is in no team
    Time changed{};                     ///< robot time at which its newest part was seen or came
  };
  /// None: nothing is known of the tile.
  [[nodiscard]] const Origin* origin_of(mapping::TileKey tile) const;
  [[nodiscard]] std::size_t tiles() const { return origins_.size(); }

  /// Tiles that have changed since the last call, in the order of their changes; a tile may come twice. After `anew`
  /// the whole map is another one.
  struct Changes {
    bool anew = false;
    std::vector<mapping::TileKey> tiles;
  };
  [[nodiscard]] Changes take_changes();

 private:
  void begin(const clients::TilesMessage& message);
  Result<void> take(const clients::TilesMessage::Tile& tile);

  clients::TileMap which_;
  mapping::SemanticOcTree tree_;
  clients::SubscribeMessage::Resume has_;
  bool caught_up_ = false;
  std::unordered_map<std::uint64_t, Origin> origins_;  // by key
  Changes changes_;
};

}  // namespace cairn::client
