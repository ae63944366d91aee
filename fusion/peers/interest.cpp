// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/interest.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "fusion/peers/items/tile_codec.hpp"

namespace cairn::peers {
namespace {

constexpr int kEdgeOfTile = 1 << mapping::TileKey::kVoxelBits,
              kMiddle = 32768;                // voxels: of a tile, from key 0 to the origin
constexpr int kReach = 5, kReachUp = 2;       // tiles to each side: 8 m and 3 m at voxels of 0.2 m
constexpr double kRingTiles = 2, kRings = 4;  // width of a ring in tiles, number of rings
constexpr std::size_t kAhead = 32;            // older updates that a wall may overtake

}  // namespace

std::optional<double> Interest::ring_of(const ItemUpdate& update) const {
  if (update.id.kind() != ItemKind::kTile) return -1;
  if (!position_odom || update.id.submap() != 0 || !has_occupied(update.payload)) return std::nullopt;
  Eigen::Vector3d off = *position_odom / (resolution_m * kEdgeOfTile);
  for (unsigned axis = 0; axis < 3; ++axis)
    off[axis] -= (update.id.tile().first_voxel(axis) - kMiddle) / static_cast<double>(kEdgeOfTile) + 0.5;
  const double ring = std::floor(off.norm() / kRingTiles);
  return ring < kRings ? std::optional(ring) : std::nullopt;
}

void Interest::sort(std::vector<ItemUpdate>& updates) const {
  std::ranges::sort(updates, {}, &ItemUpdate::version);
  using Key = std::tuple<double, bool, std::size_t>;  // the last is the place in the order of versions
  std::vector<Key> order;
  std::size_t by_age = 0;
  for (std::size_t i = 0; i < updates.size(); ++i) {
    const auto ring = ring_of(updates[i]);
    const auto ahead = static_cast<double>(ring ? 0 : by_age++ / kAhead);
    order.emplace_back(ring.value_or(kRings + ahead), !ring && !has_occupied(updates[i].payload), i);
  }
  std::ranges::sort(order);
  std::vector<ItemUpdate> sorted;
  for (const auto& [rank, free, i] : order) sorted.push_back(updates[i]);
  updates = std::move(sorted);
}

std::vector<ItemId> Interest::near_by() const {
  std::vector<ItemId> ids;
  if (!position_odom || !position_odom->allFinite()) return ids;
  const Eigen::Vector3d tile = (*position_odom / (resolution_m * kEdgeOfTile)).array().floor();
  const auto key = [&](int axis, int step) { return tile[axis] * kEdgeOfTile + kEdgeOfTile * step + kMiddle; };
  const auto inside = [](double voxel) { return voxel >= 0 && voxel < 2.0 * kMiddle; };
  const auto voxel = [](double at) { return static_cast<std::uint16_t>(at); };
  for (int z = -kReachUp; z <= kReachUp; ++z)
    for (int y = -kReach; y <= kReach; ++y)
      for (int x = -kReach; x <= kReach; ++x)
        if (inside(key(0, x)) && inside(key(1, y)) && inside(key(2, z)))
          ids.push_back(
              ItemId::tile(0, mapping::TileKey::of_voxel(voxel(key(0, x)), voxel(key(1, y)), voxel(key(2, z)))));
  return ids;
}

}  // namespace cairn::peers
