// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

#include "onboard/mapping/tree/map_tile.hpp"

namespace cairn::peers {

/// A robot's id, by its profile: its own in the team, never 0. Orders of robots are orders of their ids.
using RobotId = std::uint64_t;
/// Numbers a robot's beginnings. What it published in an earlier epoch is void. The highest is the newest. The upper
/// half counts and the lower half is random, so that a robot that has forgotten the count does not reuse a number.
using Epoch = std::uint64_t;
inline constexpr Epoch kLastEpoch = Epoch{1} << 62U;

enum class ItemKind : std::uint8_t {
  kTile = 0,        ///< own observations of one tile of a submap; payload: encode_tile()
  kSubmap = 1,      ///< where a submap lies in the robot's odom frame; payload: encode(Submap)
  kEdge = 2,        ///< where another robot's submap lies in the publisher's; payload: encode(Edge)
  kDeployment = 3,  ///< where the publisher's odom frame lies, not by maps; payload: encode(Deployment)
};

/// Names one thing that a robot publishes something about.
struct ItemId {
  std::uint64_t code = 0;  ///< kind, submap (16 bits), tile or index (39 bits): its order is the canonical one

  static constexpr unsigned kKeyBits = 39, kSubmapBits = 16;

  static constexpr ItemId tile(std::uint16_t submap, mapping::TileKey tile) {
    return of(ItemKind::kTile, submap, tile.morton);
  }
  static constexpr ItemId submap(std::uint16_t submap) { return of(ItemKind::kSubmap, submap, 0); }
  static constexpr ItemId edge(std::uint16_t index) { return of(ItemKind::kEdge, index, 0); }
  static constexpr ItemId deployment() { return of(ItemKind::kDeployment, 0, 0); }

  [[nodiscard]] constexpr ItemKind kind() const { return static_cast<ItemKind>(code >> (kKeyBits + kSubmapBits)); }
  /// The submap; of an edge, its index.
  [[nodiscard]] constexpr std::uint16_t submap() const { return static_cast<std::uint16_t>(code >> kKeyBits); }
  [[nodiscard]] constexpr mapping::TileKey tile() const { return {code & ((std::uint64_t{1} << kKeyBits) - 1)}; }
  /// Whether the functions above can have made it.
  [[nodiscard]] constexpr bool valid() const {
    return code >> (kKeyBits + kSubmapBits) <= 3 && (kind() == ItemKind::kTile || tile().morton == 0) &&
           (kind() != ItemKind::kDeployment || submap() == 0);
  }

  /// What it is about: a tile is the same thing in every submap.
  [[nodiscard]] constexpr std::uint64_t subject() const { return kind() == ItemKind::kTile ? tile().morton : code; }

  friend constexpr auto operator<=>(const ItemId&, const ItemId&) = default;

 private:
  static constexpr ItemId of(ItemKind kind, std::uint16_t submap, std::uint64_t key) {
    return {static_cast<std::uint64_t>(kind) << (kKeyBits + kSubmapBits) | std::uint64_t{submap} << kKeyBits | key};
  }
};

/// Of two items about the same thing, only the newer one is held.
struct BySubject {
  constexpr bool operator()(const ItemId& x, const ItemId& y) const { return x.subject() < y.subject(); }
};

/// No item's payload is longer.
inline constexpr std::size_t kMaxPayload = 768;

}  // namespace cairn::peers
