// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fusion/peers/items/holding.hpp"
#include "fusion/peers/items/item.hpp"

namespace cairn::peers {

/// What a peer can use first of what a robot says: claims; then walls near itself, where that is known, the nearest
/// first; then the rest by age, walls a little before what is only free. Not by more than a little, and not the newest
/// first: versions that overtake others leave gaps in what the peer knows, of which it can tell only so many
/// (VersionSet), and on a link that cannot carry everything, tiles that change again and again would keep out those
/// that were never sent.
struct Interest {
  std::optional<Eigen::Vector3d> position_odom;  ///< of the peer in the other robot's odom frame, metres
  double resolution_m = 0.2;

  /// Most urgent first.
  void sort(std::vector<ItemUpdate>& updates) const;
  /// Tiles around the peer, of which some may not exist: what is sent to it however old it is. Some hundreds at most.
  [[nodiscard]] std::vector<ItemId> near_by() const;

 private:
  /// How near, in rings; nothing for what is not near, not a wall, or not known to be.
  [[nodiscard]] std::optional<double> ring_of(const ItemUpdate& update) const;
};

}  // namespace cairn::peers
