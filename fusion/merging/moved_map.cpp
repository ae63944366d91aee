// SPDX-License-Identifier: Apache-2.0
#include "fusion/merging/moved_map.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "fusion/merging/placed_tiles.hpp"

namespace cairn::merging {
namespace {

using mapping::TileKey;

TileLayer layer_of(const mapping::SemanticOcTree& map) {
  TileLayer layer;
  for (const TileKey tile : mapping::known_tiles(map, std::numeric_limits<std::size_t>::max()))
    layer.emplace_hint(layer.end(), tile, ReceivedTile{.state = mapping::read_tile(map, tile)});
  return layer;
}

void add_tiles_of(const TileBox& box, std::vector<TileKey>& tiles) {
  constexpr int kTiles = (1 << mapping::SemanticOcTree::kDepth) / mapping::kTileEdge;
  const Eigen::Vector3i low = box.low.cwiseMax(0), high = box.high.cwiseMin(kTiles - 1);
  const auto voxel = [](int tile) { return static_cast<std::uint16_t>(tile * mapping::kTileEdge); };
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z) tiles.push_back(TileKey::of_voxel(voxel(x), voxel(y), voxel(z)));
}

/// In canonical order, each once.
std::vector<TileKey> touched_by(const TileLayer& layer, const Placement& placement) {
  std::vector<TileKey> tiles;
  for (const auto& [tile, received] : layer) add_tiles_of(placement.touched_by(tile), tiles);
  std::ranges::sort(tiles);
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  return tiles;
}

}  // namespace

Result<std::unique_ptr<mapping::SemanticOcTree>> moved_map(const mapping::SemanticOcTree& map, const SE3& T_new_map) {
  const auto placement = Placement::of(T_new_map, map.getResolution());
  if (!placement) return Error{Errc::kInvalidConfig, "the pose is not finite, or leads out of the tree", {}, {}, {}};
  auto moved = std::make_unique<mapping::SemanticOcTree>(map.getResolution());
  moved->set_sensor_model(map.sensor_model());
  const TileLayer layer = layer_of(map);
  Placement::Opinion opinion;
  for (const TileKey tile : touched_by(layer, *placement))
    if (placement->read(layer, tile, opinion))
      mapping::write_tile(*moved, tile, opinion.voxels, opinion.labelled ? &opinion.labels : nullptr);
  return moved;
}

}  // namespace cairn::merging
