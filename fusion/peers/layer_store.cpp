// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/layer_store.hpp"

#include <algorithm>
#include <utility>

namespace cairn::peers {

Layer& LayerStore::restart(RobotId robot, Epoch epoch) {
  changes_[robot] = {true, {}};
  return layers_.insert_or_assign(robot, Layer{epoch, Holding()}).first->second;
}

void LayerStore::begin(Epoch epoch) { restart(self_, epoch); }

bool LayerStore::say(ItemId id, std::span<const std::byte> payload) {
  if (!layers_.at(self_).holding.say(id, payload)) return false;
  changes_[self_].items.insert(id);
  return true;
}

void LayerStore::outdo(Epoch epoch) {
  const Holding said = std::move(layers_.at(self_).holding);
  begin(std::min(epoch + 1, kLastEpoch));
  for (const auto& [id, item] : said.items()) say(id, item.payload);
}

void LayerStore::hear_of(RobotId robot, Epoch epoch) {
  const auto layer = layers_.find(robot);
  if (layer != layers_.end() && layer->second.epoch < epoch) restart(robot, epoch);
}

/// Where the items of a robot's epoch go; null if they are not wanted.
Layer* LayerStore::layer_of(RobotId robot, Epoch epoch) {
  const auto layer = layers_.find(robot);
  if (layer == layers_.end()) return layers_.size() > limits_.robots ? nullptr : &restart(robot, epoch);
  if (layer->second.epoch < epoch) return &restart(robot, epoch);
  return layer->second.epoch == epoch ? &layer->second : nullptr;
}

std::size_t LayerStore::room_for(RobotId robot) const {
  std::size_t left = limits_.spare_bytes;
  for (const auto& [other, layer] : layers_) {
    if (other == self_ || other == robot) continue;
    const std::size_t more = std::max(layer.holding.bytes(), limits_.bytes) - limits_.bytes;
    left -= std::min(left, more);
  }
  return limits_.bytes + left;
}

LayerStore::Taken LayerStore::take(const Items& items) {
  Taken taken;
  Layer* layer = layer_of(items.robot, items.epoch);
  if (layer == nullptr) return taken;
  taken.wanted = true;
  layer->holding.settle(items.superseded);
  const std::size_t room = room_for(items.robot);
  for (const ItemUpdate& update : items.updates) {
    const auto one = layer->holding.take(update, room);
    if (one == Holding::Taken::kFull) {
      taken.full = true;
      continue;
    }
    if (one == Holding::Taken::kNew) changes_[items.robot].items.insert(update.id);
    ++(one == Holding::Taken::kNew ? taken.fresh : taken.repeated);
  }
  return taken;
}

Changes LayerStore::take_changes() { return std::exchange(changes_, {}); }

}  // namespace cairn::peers
