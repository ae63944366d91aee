// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/tiles/robot_tiles.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace cairn::team {
namespace {

constexpr int kHalfTree = 1 << 12, kTiles = 1 << 13;  // tiles along an axis
constexpr int kVoxels = 1 << mapping::TileKey::kVoxelBits;

Eigen::Vector3d centre_of(mapping::TileKey tile, double tile_m) {
  Eigen::Vector3d centre;
  for (unsigned axis = 0; axis < 3; ++axis)
    centre[static_cast<Eigen::Index>(axis)] = tile.first_voxel(axis) / kVoxels - kHalfTree + 0.5;
  return tile_m * centre;
}

std::optional<mapping::TileKey> tile_at(const Eigen::Vector3d& point, double tile_m) {
  const Eigen::Array3d tile = (point / tile_m).array().floor() + kHalfTree;
  if ((tile < 0).any() || (tile >= kTiles).any()) return std::nullopt;
  const auto voxel = [&](Eigen::Index axis) { return static_cast<std::uint16_t>(tile[axis] * kVoxels); };
  return mapping::TileKey::of_voxel(voxel(0), voxel(1), voxel(2));
}

}  // namespace

std::optional<std::uint16_t> RobotTiles::put(mapping::TileKey tile, std::uint16_t submap, bool occupied) {
  const auto [entry, added] = submap_of_.try_emplace(tile, submap);
  const std::uint16_t before = std::exchange(entry->second, submap);
  if (!added) {
    const auto walls = walls_.find(before);
    if (walls != walls_.end()) {
      count_ -= walls->second.erase(tile);
      if (walls->second.empty()) walls_.erase(walls);
    }
  }
  if (occupied) count_ += walls_[submap].insert(tile).second ? 1 : 0;
  return before == submap ? std::nullopt : std::optional(before);
}

RobotTiles::Tiles RobotTiles::all_walls() const {
  Tiles all;
  for (const auto& [submap, walls] : walls_) all.insert(walls.begin(), walls.end());
  return all;
}

std::size_t common_tiles(const RobotTiles::Tiles& a, const RobotTiles::Tiles& b, const SE3& T_b_a, double tile_m) {
  return static_cast<std::size_t>(std::ranges::count_if(a, [&](mapping::TileKey tile) {
    const auto in_b = tile_at(T_b_a * centre_of(tile, tile_m), tile_m);
    return in_b && b.contains(*in_b);
  }));
}

}  // namespace cairn::team
