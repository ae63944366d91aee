// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "hal/spsc_queue.hpp"
#include "hal/time.hpp"
#include "onboard/mapping/tree/tile_state.hpp"

namespace cairn::app {

/// A tile of a map as it is now.
struct TileNews {
  std::uint32_t epoch = 0;  ///< of the map
  mapping::TileKey tile;
  mapping::TileState state;  ///< empty: nothing is known of it any more
  Time changed{};
  std::vector<std::uint64_t> contributors;  ///< ids of robots, ascending; of a team's map only
};

/// The tiles of a map that have changed, from the task that owns the map to the one that serves clients. Neither ever
/// waits. What finds no room is owed, and goes later: only the newest state of a tile matters, and none is lost.
class TileOutlet {
 public:
  /// `capacity`: tiles that may wait for the consumer.
  explicit TileOutlet(std::size_t capacity = 2048) : tiles_(capacity) {}

  /// Producer: what is handed over from now on is of the map of this epoch. What is owed of another map is forgotten.
  /// Tiles that are owed before the first call are of epoch 0.
  void begin(std::uint32_t epoch) {
    if (epoch != epoch_.value_or(0)) owed_.clear();
    epoch_ = epoch;
    note();
  }
  /// Producer: these tiles have changed.
  void owe(std::span<const mapping::TileKey> tiles) {
    owed_.insert(tiles.begin(), tiles.end());
    note();
  }
  /// Producer: hands over tiles that are owed, as `read(TileNews&)` fills them in for the tile that is set, while there
  /// is room, and not more than `most`. Nothing happens before begin().
  template <class Read>
  void hand_over(std::size_t most, Read read) {
    for (std::size_t i = 0; i < most && epoch_ && !owed_.empty(); ++i) {
      TileNews* out = tiles_.back();
      if (out == nullptr) break;
      out->epoch = *epoch_;
      out->tile = *owed_.begin();
      out->contributors.clear();
      read(*out);
      owed_.erase(owed_.begin());
      tiles_.push();
    }
    note();
  }
  /// Producer: how many tiles are owed.
  [[nodiscard]] std::size_t owed() const { return owed_.size(); }

  /// For the consumer.
  [[nodiscard]] SpscQueue<TileNews>& tiles() { return tiles_; }
  /// Consumer: nothing is owed, and nothing waits.
  [[nodiscard]] bool settled() const { return nothing_owed_.load(std::memory_order_acquire) && tiles_.size() == 0; }

 private:
  void note() { nothing_owed_.store(owed_.empty(), std::memory_order_release); }

  std::optional<std::uint32_t> epoch_;
  std::set<mapping::TileKey> owed_;
  std::atomic<bool> nothing_owed_{true};
  SpscQueue<TileNews> tiles_;
};

}  // namespace cairn::app
