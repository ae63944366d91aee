// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "fusion/peers/exchange.hpp"
#include "hal/time.hpp"
#include "onboard/mapping/tile_state.hpp"

namespace cairn::peers {

struct OwnTilesConfig {
  Duration first = std::chrono::milliseconds(500);  ///< a tile is said so long after it was first seen
  Duration settled = std::chrono::seconds(2);       ///< and again when it has not changed for so long,
  Duration restless = std::chrono::seconds(15);     ///< or, where it goes on changing, so long after the last time
};

/// What a robot says of its own map, and when: every scan changes a thousand tiles, each by a few voxels, and a radio
/// link carries a few hundred a second. So a tile is said soon after it was first seen, and then when it has settled.
class OwnTiles {
 public:
  explicit OwnTiles(const OwnTilesConfig& config) : config_(config) {}

  void observe(TileKey tile, const TileState& state, Time now) {
    auto [waiting, added] = waiting_.try_emplace(tile);
    if (added) waiting->second.first = now;
    waiting->second.state = state;
    waiting->second.last = now;
  }
  /// Says what is due.
  void say(Exchange& exchange, Time now);
  void clear() { waiting_.clear(); }

 private:
  struct Waiting {
    TileState state;
    Time first{}, last{};
  };
  OwnTilesConfig config_;
  std::map<TileKey, Waiting> waiting_;
};

}  // namespace cairn::peers
