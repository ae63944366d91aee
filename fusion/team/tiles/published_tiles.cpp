// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/tiles/published_tiles.hpp"

#include <limits>
#include <span>

#include "fusion/merging/team_map.hpp"
#include "fusion/peers/items/tile_codec.hpp"

namespace cairn::team {
namespace {

Result<mapping::TileState> state_of(const PublishedTiles& published, const PublishedTiles::Tile& tile) {
  return peers::decode_tile(std::span(published.payloads).subspan(tile.begin, tile.bytes));
}

mapping::SemanticOcTree map_in_odom(const PublishedTiles& published) {
  mapping::SemanticOcTree map(published.resolution_m);
  for (const PublishedTiles::Tile& tile : published.tiles)
    if (const auto state = state_of(published, tile)) mapping::write_tile(map, tile.key, *state);
  return map;
}

mapping::SemanticOcTree map_of_moved_submaps(const PublishedTiles& published) {
  merging::TeamMap moved(published.resolution_m, merging::Policy::kRelativeEntropy);
  merging::SubmapPoses poses;
  for (const PublishedTiles::Tile& tile : published.tiles) {
    const merging::SubmapKey submap{0, tile.submap};  // there is only one robot
    if (const auto state = state_of(published, tile)) moved.put(submap, tile.key, *state, Time{});
    poses.emplace(submap, published.T_map_odom_of(tile.submap));
  }
  moved.place(poses);
  Budget all = Budget::steps(std::numeric_limits<int>::max());
  (void)moved.fuse(all);
  return moved.map();
}

}  // namespace

PublishedTiles PublishedTiles::of(const peers::Holding& holding, double resolution_m,
                                  std::optional<std::uint16_t> submap) {
  PublishedTiles published{.resolution_m = resolution_m};
  for (const auto& [id, item] : holding.items()) {
    if (id.kind() != peers::ItemKind::kTile || id.submap() != submap.value_or(id.submap())) continue;
    published.tiles.push_back(
        {.key = id.tile(), .submap = id.submap(), .begin = published.payloads.size(), .bytes = item.payload.size()});
    published.payloads.insert(published.payloads.end(), item.payload.begin(), item.payload.end());
  }
  return published;
}

SE3 PublishedTiles::T_map_odom_of(std::uint16_t submap) const {
  const auto found = T_map_odom.find(submap);
  return found == T_map_odom.end() ? SE3() : found->second;
}

mapping::SemanticOcTree PublishedTiles::map() const {
  return T_map_odom.empty() ? map_in_odom(*this) : map_of_moved_submaps(*this);
}

}  // namespace cairn::team
