// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/clients/messages/record.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// Which map a tile is of.
enum class TileMap : std::uint8_t {
  kOwn,   ///< what the robot has seen itself, in its odom frame
  kTeam,  ///< the map of all robots, in the team's frame
};

/// The newest state of some tiles of one map. A tile is a cube of 8×8×8 voxels.
struct TilesMessage {
  static constexpr RecordKind kKind = RecordKind::kTiles;
  static constexpr std::size_t kMaxTileBytes = 2048, kMaxContributors = 8;

  /// One tile.
  struct Tile {
    std::uint64_t key = 0;      ///< path from the root of the tree, three bits a level; below 2³⁹
    std::uint64_t version = 0;  ///< counts changes within a session, ascending in a record and from one to the next
    Time changed{};             ///< when the newest of what it tells was seen or came
    std::vector<std::uint64_t> contributors{};  ///< ids of the robots that saw it, ascending, kMaxContributors at most
    std::vector<std::byte> bytes{};             ///< as robots exchange it; empty: nothing is known of it any more
  };
  TileMap map{};
  bool caught_up = false;     ///< the client has everything now
  std::uint64_t session = 0;  ///< see HelloMessage. A mirror of another session or epoch is void
  std::uint32_t epoch = 0;    ///< of the map
  std::vector<Tile> tiles{};
};

/// Fills a record with tiles, as many as fit.
class TilesWriter {
 public:
  /// `head`: all but its tiles and `caught_up` counts. `out` must outlive the writer. The body is: map (1), caught up
  /// (1), number of tiles (2), epoch (4), session (8); for each tile key (8), version (8), changed (8), number of
  /// contributors (1) and of bytes (2), contributors (8 each), bytes.
  TilesWriter(const TilesMessage& head, std::uint32_t sequence, std::vector<std::byte>& out);
  /// False: the record is full.
  bool add(const TilesMessage::Tile& tile);
  [[nodiscard]] std::size_t tiles() const { return tiles_; }
  /// Ends the record; `caught_up`: the client has everything with it.
  void finish(bool caught_up);

 private:
  std::vector<std::byte>& out_;
  std::uint16_t tiles_ = 0;
};

/// Error kMalformed. What the tiles' bytes say is not looked at.
[[nodiscard]] Result<TilesMessage> decode_tiles(std::span<const std::byte> body);

}  // namespace cairn::clients
