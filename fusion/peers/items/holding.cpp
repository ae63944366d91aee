// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/holding.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "fusion/peers/items/item_memory.hpp"

namespace cairn::peers {

bool Holding::say(ItemId id, std::span<const std::byte> payload) {
  const auto held = items_.find(id);
  if (held != items_.end() && std::ranges::equal(held->second.payload, payload)) return false;
  const Version version = newest() + 1;
  put(id, version, payload);
  known_.add({1, version});
  return true;
}

Holding::Taken Holding::take(const ItemUpdate& update, std::size_t max_bytes) {
  const auto held = items_.find(update.id);
  const bool known = held != items_.end() && held->second.version >= update.version;
  if (!known) {
    const std::size_t room = max_bytes + (update.id.kind() == ItemKind::kTile ? 0 : kForOthers);
    const std::size_t before = held != items_.end() ? memory_of(update.id, held->second.payload) : 0;
    if (bytes_ - before + memory_of(update.id, update.payload) > room) return Taken::kFull;
  }
  known_.add(update.settles());
  if (known) return Taken::kKnown;
  put(update.id, update.version, update.payload);
  return Taken::kNew;
}

/// The same thing, said in another submap.
Holding::Items::iterator Holding::under(ItemId id, Items::iterator held) {
  auto node = items_.extract(held);
  node.key() = id;
  return items_.insert(std::move(node)).position;
}

void Holding::put(ItemId id, Version version, std::span<const std::byte> payload) {
  auto [held, added] = items_.try_emplace(id);
  if (!added) {
    const ItemId before = held->first;
    if (const auto old = by_version_.find(held->second.version); old != by_version_.end() && old->second == before)
      by_version_.erase(old);
    bytes_ -= memory_of(before, held->second.payload);
    if (before != id) held = under(id, held);
  }
  held->second.version = version;
  held->second.payload.assign(payload.begin(), payload.end());
  bytes_ += memory_of(id, payload);
  // Two items of one version: only a peer that lies can say that; the later one is not offered to others.
  by_version_.try_emplace(version, id);
}

ItemUpdate Holding::update_of(ByVersion::const_iterator held) const {
  const Version version = held->first;
  Version from = held == by_version_.begin() ? 1 : std::prev(held)->first + 1;
  from = std::max(from, known_.contains(version) ? known_.start_of_run(version) : version);
  return {held->second, version, version - from, items_.at(held->second).payload};
}

void Holding::settle(const VersionSet& superseded) {
  for (const VersionRange& range : superseded.ranges()) known_.add(range);
}

/// What this holding knows to be superseded of a gap in which, or after the last update of which, nothing is held.
void Holding::note_superseded(VersionRange gap, VersionSet& out) const {
  for (const VersionRange& known : known_.ranges())
    out.add({std::max(known.first, gap.first), std::min(known.last, gap.last)});
}

/// Tiles come before all others, by subject.
std::vector<ItemId> Holding::without_tiles() const {
  std::vector<ItemId> ids;
  for (auto item = items_.lower_bound(ItemId::submap(0)); item != items_.end(); ++item) ids.push_back(item->first);
  return ids;
}

std::vector<ItemUpdate> Holding::missing_of(std::span<const ItemId> ids, const VersionSet& at_peer) const {
  std::vector<ItemUpdate> updates;
  for (const ItemId id : ids) {
    const auto item = items_.find(id);
    if (item == items_.end() || at_peer.contains(item->second.version)) continue;
    const auto held = by_version_.find(item->second.version);
    if (held != by_version_.end() && held->second == id) updates.push_back(update_of(held));
  }
  return updates;
}

Missing Holding::missing(const VersionSet& at_peer, std::size_t most) const {
  Missing missing;
  Version after = 0;  // all up to this one is settled
  for (std::size_t i = 0; i <= at_peer.ranges().size(); ++i) {
    const VersionRange next = i < at_peer.ranges().size() ? at_peer.ranges()[i] : VersionRange{newest() + 1, 0};
    for (auto held = by_version_.upper_bound(after); held != by_version_.end() && held->first < next.first; ++held) {
      if (missing.updates.size() == most) return missing;
      missing.updates.push_back(update_of(held));
      after = held->first;
    }
    if (after + 1 < next.first) note_superseded({after + 1, next.first - 1}, missing.superseded);
    after = next.last;
  }
  return missing;
}

}  // namespace cairn::peers
