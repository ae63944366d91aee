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

/// An item on its way, and which versions are settled with it.
struct ItemUpdate {
  ItemId id;
  Version version = 0;
  Version superseded = 0;  ///< so many versions just before this one are of items that have newer ones
  std::span<const std::byte> payload;

  [[nodiscard]] VersionRange settles() const { return {version - superseded, version}; }
};

/// What a holding has that another lacks.
struct Missing {
  std::vector<ItemUpdate> updates;  ///< by ascending version
  VersionSet superseded;            ///< versions that nothing is left of, and that the updates do not settle
};

/// What is held of one robot's items in one epoch: the newest version of each item, and which versions were taken in or
/// are superseded. Each change of an item has a version of its own, one more than the last of any item. So a robot that
/// knows all versions up to one knows all that was published until then, and a few ranges tell what it lacks. Updates
/// may come twice, late and in any order: the result is the same.
class Holding {
 public:
  /// The newest version of one item and its payload.
  struct Item {
    Version version = 0;
    std::vector<std::byte> payload;
  };
  using Items = std::map<ItemId, Item, BySubject>;
  enum class Taken : std::uint8_t { kNew, kKnown, kFull };

  /// The robot itself publishes an item. False if it published the same last. Not for another robot's holding.
  bool say(ItemId id, std::span<const std::byte> payload);
  /// Takes in an update of another robot; `update.version` is above `update.superseded`. All that is held may take
  /// `max_bytes`, see memory_of(); kForOthers more where the update is no tile. Without submaps and edges, tiles are of
  /// no use.
  Taken take(const ItemUpdate& update, std::size_t max_bytes);
  static constexpr std::size_t kForOthers = std::size_t{4} << 20U;  ///< some 9000 of them

  /// A tile is found with any submap in its id. The key has the submap that it was published in.
  [[nodiscard]] const Items& items() const { return items_; }
  [[nodiscard]] const VersionSet& known() const { return known_; }
  /// The highest version held; 0 if it is empty.
  [[nodiscard]] Version newest() const { return by_version_.empty() ? 0 : by_version_.rbegin()->first; }
  /// What is held and is not in `at_peer`: at most the `most` lowest versions. The payloads are valid until the holding
  /// changes.
  [[nodiscard]] Missing missing(const VersionSet& at_peer, std::size_t most) const;
  /// All that is held but tiles: where submaps lie, edges and deployments.
  [[nodiscard]] std::vector<ItemId> without_tiles() const;
  /// Those of `ids` that are held, and whose newest version is not in `at_peer`.
  [[nodiscard]] std::vector<ItemUpdate> missing_of(std::span<const ItemId> ids, const VersionSet& at_peer) const;
  /// These versions are superseded: they are not waited for.
  void settle(const VersionSet& superseded);
  /// Memory of all that is held; see memory_of().
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  using ByVersion = std::map<Version, ItemId>;
  [[nodiscard]] ItemUpdate update_of(ByVersion::const_iterator held) const;
  void note_superseded(VersionRange gap, VersionSet& out) const;
  Items::iterator under(ItemId id, Items::iterator held);
  void put(ItemId id, Version version, std::span<const std::byte> payload);

  std::size_t bytes_ = 0;
  Items items_;
  ByVersion by_version_;
  VersionSet known_;
};

}  // namespace cairn::peers
