// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "fusion/peers/items/item.hpp"
#include "fusion/peers/items/version_set.hpp"

namespace cairn::peers {

/// An item on its way: what it says, and what is known with it.
struct ItemUpdate {
  ItemId id;
  Version version = 0;
  Version superseded = 0;  ///< that many versions just before this one are of items that have newer ones
  std::span<const std::byte> payload;

  [[nodiscard]] VersionRange settles() const { return {version - superseded, version}; }
};

/// What a holding knows that another does not.
struct Missing {
  std::vector<ItemUpdate> updates;  ///< by ascending version
  VersionSet superseded;            ///< versions that the updates do not settle, and that nothing is left of
};

/// All that is held of what one robot says in one epoch: the newest version of each item, and which versions have been
/// taken in or are known to be superseded. Every change of an item has a version of its own, one more than the last of
/// any item, so a robot that knows all versions up to one knows all that was said until then, and a few ranges say what
/// it misses. Taking in updates twice, late or in any order comes to the same.
class Holding {
 public:
  struct Item {
    Version version = 0;
    std::vector<std::byte> payload;
  };
  using Items = std::map<ItemId, Item, BySubject>;
  enum class Taken : std::uint8_t { kNew, kKnown, kFull };
  static constexpr std::size_t kMaxBytes = std::size_t{64}
                                           << 20;  ///< of items, with what is made of them: see memory_of()

  explicit Holding(std::size_t max_bytes = kMaxBytes) : max_bytes_(max_bytes) {}

  /// The robot itself says something new, unless it said the same last time; false then. Not on another robot's.
  bool say(ItemId id, std::span<const std::byte> payload);
  /// `update` is valid: version > superseded.
  Taken take(const ItemUpdate& update);

  /// A tile is found under whatever submap one asks for it; the key says which one it was said in.
  [[nodiscard]] const Items& items() const { return items_; }
  [[nodiscard]] const VersionSet& known() const { return known_; }
  /// The highest version held.
  [[nodiscard]] Version newest() const { return by_version_.empty() ? 0 : by_version_.rbegin()->first; }
  /// What is held and `at_peer` does not contain, the `most` lowest versions at the most. The payloads are valid until
  /// the holding changes.
  [[nodiscard]] Missing missing(const VersionSet& at_peer, std::size_t most) const;
  /// Those of `ids` that are held and whose newest version `at_peer` does not contain.
  [[nodiscard]] std::vector<ItemUpdate> missing_of(std::span<const ItemId> ids, const VersionSet& at_peer) const;
  /// Versions that have been superseded, as far as the sender knows; they need not be waited for.
  void settle(const VersionSet& superseded);
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  using ByVersion = std::map<Version, ItemId>;
  [[nodiscard]] ItemUpdate update_of(ByVersion::const_iterator held) const;
  void note_superseded(VersionRange gap, VersionSet& out) const;
  Items::iterator under(ItemId id, Items::iterator held);
  void put(ItemId id, Version version, std::span<const std::byte> payload);

  std::size_t max_bytes_, bytes_ = 0;
  Items items_;
  ByVersion by_version_;
  VersionSet known_;
};

}  // namespace cairn::peers
