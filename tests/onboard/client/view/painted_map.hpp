// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "fusion/peers/items/tile_codec.hpp"
#include "onboard/client/map_mirror.hpp"

namespace cairn::client::test {

/// A mirror of a map that a test paints box by box, with voxels of 0.1 m.
class PaintedMap {
 public:
  explicit PaintedMap(clients::TileMap which = clients::TileMap::kOwn) : which_(which), mirror_(which, 0.1) {}

  /// All voxels whose centres are in the box, m; later boxes paint over earlier ones.
  PaintedMap& box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, bool occupied) {
    for (double x = low.x() + 0.05; x < high.x(); x += 0.1)
      for (double y = low.y() + 0.05; y < high.y(); y += 0.1)
        for (double z = low.z() + 0.05; z < high.z(); z += 0.1)
          tree_.setNodeValue(octomap::point3d(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)),
                             occupied ? 3.5F : -1.6F, true);
    return *this;
  }
  /// What a client has of it.
  const MapMirror& mirror(std::uint64_t robot = 1, Time changed = {}) {
    tree_.updateInnerOccupancy();
    clients::TilesMessage message{.map = which_, .caught_up = true, .session = 1};
    for (const mapping::TileKey key : mapping::known_tiles(tree_, std::numeric_limits<std::size_t>::max())) {
      auto& tile = message.tiles.emplace_back();
      tile.key = key.morton;
      tile.version = ++version_;
      tile.changed = changed;
      tile.contributors = {robot};
      peers::encode_tile(mapping::read_tile(tree_, key), tile.bytes);
    }
    EXPECT_TRUE(mirror_.take(message));
    return mirror_;
  }

 private:
  clients::TileMap which_;
  mapping::SemanticOcTree tree_{0.1};
  MapMirror mirror_;
  std::uint64_t version_ = 0;
};

}  // namespace cairn::client::test
