// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fusion/peers/items/holding.hpp"
#include "fusion/peers/items/item.hpp"

namespace cairn::peers {

/// What a peer can use first of what a robot publishes:
/// 1. edges, submaps and deployments;
/// 2. walls near the peer, the nearest first, if its place is known; only those of the robot's submap 0;
/// 3. the rest by age, walls a little before free space.
/// Older items are not overtaken by much. Versions that overtake others leave gaps in what the peer knows, and a
/// VersionSet can tell of few. On a slow link, tiles that change often would keep out tiles that were never sent.
struct Interest {
  std::optional<Eigen::Vector3d> position_odom;  ///< of the peer, in the robot's odom frame, metres
  double resolution_m = 0.2;                     ///< edge of a voxel

  /// Most urgent first.
  void sort(std::vector<ItemUpdate>& updates) const;
  /// The ids of the tiles around the peer, some hundreds at most. Some of the tiles may not exist.
  [[nodiscard]] std::vector<ItemId> near_by() const;

 private:
  /// The ring around the peer that an item lies in. Nothing for tiles that are far away or have no wall.
  [[nodiscard]] std::optional<double> ring_of(const ItemUpdate& update) const;
};

}  // namespace cairn::peers
