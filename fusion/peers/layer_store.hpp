// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>

#include "fusion/peers/datagrams/datagram.hpp"
#include "fusion/peers/items/holding.hpp"
#include "fusion/peers/items/item.hpp"

namespace cairn::peers {

/// What one robot publishes, as far as it is known here.
struct Layer {
  Epoch epoch = 0;
  Holding holding;
};
using Layers = std::map<RobotId, Layer>;

/// What changed in what is known of a robot.
struct LayerChange {
  bool anew = false;  ///< a new epoch: all earlier items are void
  std::set<ItemId> items;
};
using Changes = std::map<RobotId, LayerChange>;

/// What all robots publish, as far as it is known here; this robot's own too.
class LayerStore {
 public:
  /// What is kept at most.
  struct Limits {
    std::size_t robots = 16;      ///< others than this one
    std::size_t bytes = 0;        ///< of memory, that the tiles of each robot may take in any case
    std::size_t spare_bytes = 0;  ///< that the tiles of those which need more may take together
  };
  LayerStore(RobotId self, Epoch epoch, const Limits& limits) : self_(self), limits_(limits) { begin(epoch); }

  /// This robot begins anew: what it has published is void.
  void begin(Epoch epoch);
  /// This robot publishes an item. False if the item is published already.
  bool say(ItemId id, std::span<const std::byte> payload);
  /// This robot publishes all its items again, in an epoch after `epoch`.
  void outdo(Epoch epoch);
  /// A robot is in this epoch: what it published in earlier ones is void.
  void hear_of(RobotId robot, Epoch epoch);

  /// What take() has done.
  struct Taken {
    bool wanted = false;  ///< false: of an earlier epoch, or of one robot too many; nothing was taken
    bool full = false;    ///< true: the robot publishes more than is kept; tiles beyond that were left out
    std::size_t fresh = 0, repeated = 0;  ///< items that were news, and that were known already
  };
  /// Takes in items of another robot.
  Taken take(const Items& items);

  [[nodiscard]] const Layers& all() const { return layers_; }
  [[nodiscard]] const Layer& own() const { return layers_.at(self_); }
  /// What changed since the last call.
  [[nodiscard]] Changes take_changes();

 private:
  Layer& restart(RobotId robot, Epoch epoch);
  Layer* layer_of(RobotId robot, Epoch epoch);
  /// What the tiles of this robot may take now.
  [[nodiscard]] std::size_t room_for(RobotId robot) const;

  RobotId self_;
  Limits limits_;
  Layers layers_;
  Changes changes_;
};

}  // namespace cairn::peers
