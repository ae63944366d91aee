// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "fusion/peers/exchange.hpp"
#include "fusion/peers/submap_check.hpp"
#include "hal/time.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::peers {

/// When a changed tile is told to others.
struct OwnTilesConfig {
  /// A tile is first published so long after it was first observed.
  Duration first = std::chrono::milliseconds(500);
  /// A tile that has changed by `much` is published again when it has not changed for so long. A tile that has changed
  /// by half as much waits twice as long, and so on, up to `longest`.
  Duration settled = std::chrono::seconds(10);
  double much_first = 60;                        ///< changed voxels (see change_between()), the second time
  double much = 800;                             ///< changed voxels, from the third time on
  Duration longest = std::chrono::seconds(240);  ///< the longest wait of a settled tile
  int restless = 3;                              ///< a tile that goes on changing waits so many times as long
  Duration round = std::chrono::seconds(1);      ///< tiles are published together so often, to fill datagrams
  Duration quiet = std::chrono::seconds(5);      ///< no tile has changed for so long: all that wait are published
};

/// How many voxels have changed: those that became known, turned free or occupied, or have another label. Voxels that
/// only became more or less sure count a quarter.
[[nodiscard]] double change_between(const mapping::TileState& said, const mapping::TileState& now);

/// Which tiles of its own map a robot publishes, and when. A scan changes a thousand tiles by a few voxels each, and a
/// radio link carries a few hundred tiles a second. So a tile is published soon after it was first observed, and again
/// when it has settled. The less has changed in it, the longer it waits.
class OwnTiles {
 public:
  explicit OwnTiles(const OwnTilesConfig& config) : config_(config) {}

  /// A tile has changed. `submap`: the present one, which the tile is published in. Returns what became of the walls
  /// that it had when it was observed or published last.
  SeenAgain observe(mapping::TileKey tile, const mapping::TileState& state, Time now, std::uint16_t submap = 0);
  /// Publishes the tiles that are due.
  void say(Exchange& exchange, Time now);
  /// Tiles that were observed at `since` or later are not published as they are now. Returns how many these are.
  std::size_t forget(Time since);
  /// The robot's map begins anew.
  void clear() {
    waiting_.clear();
    said_.clear();
  }
  /// How many tiles wait to be published.
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Waiting {
    mapping::TileState state;
    std::uint16_t submap = 0;
    Time first{}, last{};
  };
  struct Said {
    mapping::TileState state;
    std::uint16_t submap = 0;
    bool again = false;  // more than once
  };
  [[nodiscard]] bool due(const Waiting& waiting, const Said* said, Time now) const;

  OwnTilesConfig config_;
  Time next_round_ = Time::min(), last_{};
  std::map<mapping::TileKey, Waiting> waiting_;
  std::map<mapping::TileKey, Said> said_;
};

}  // namespace cairn::peers
