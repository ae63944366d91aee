// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "fusion/peers/exchange.hpp"
#include "hal/time.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::peers {

struct OwnTilesConfig {
  Duration first = std::chrono::milliseconds(500);  ///< a tile is said so long after it was first seen
  Duration settled = std::chrono::seconds(10);      ///< and again when it has not changed for so long, if so much
  double much_first = 60;                           ///< is new in it (see change_between()), the first time,
  double much = 800;                                ///< or so much, from then on; where there is less,
  Duration longest = std::chrono::seconds(240);     ///< it waits longer by so much, up to this;
  int restless = 3;                                 ///< or, where it goes on changing, after so many times as long
  Duration round = std::chrono::seconds(1);         ///< what is due is said together, so that datagrams are full
  Duration quiet = std::chrono::seconds(5);         ///< nothing changes any more: whatever waits is said
};

/// Voxels that became known, changed sides or have another label, and a quarter of those that became surer or less
/// sure.
[[nodiscard]] double change_between(const TileState& said, const TileState& now);

/// What a robot says of its own map, and when: every scan changes a thousand tiles, each by a few voxels, and a radio
/// link carries a few hundred a second. So a tile is said soon after it was first seen, and then when it has settled:
/// the less there is in it that peers do not know, the longer it waits.
class OwnTiles {
 public:
  explicit OwnTiles(const OwnTilesConfig& config) : config_(config) {}

  /// `submap`: the present one; the tile is said in it.
  void observe(TileKey tile, const TileState& state, Time now, std::uint16_t submap = 0) {
    auto [waiting, added] = waiting_.try_emplace(tile);
    if (added) waiting->second.first = now;
    waiting->second.state = state;
    waiting->second.submap = submap;
    waiting->second.last = last_ = now;
  }
  /// Says what is due.
  void say(Exchange& exchange, Time now);
  void clear() {
    waiting_.clear();
    said_.clear();
  }
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Waiting {
    TileState state;
    std::uint16_t submap = 0;
    Time first{}, last{};
  };
  struct Said {
    TileState state;
    std::uint16_t submap = 0;
    bool again = false;  // more than once
  };
  [[nodiscard]] bool due(const Waiting& waiting, const Said* said, Time now) const;

  OwnTilesConfig config_;
  Time next_round_ = Time::min(), last_{};
  std::map<TileKey, Waiting> waiting_;
  std::map<TileKey, Said> said_;
};

}  // namespace cairn::peers
