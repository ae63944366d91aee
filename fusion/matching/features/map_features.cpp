// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/map_features.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::matching {
namespace {

// Powers of two: 0.2 m over 0.1 m counts as 2 whatever the rounding.
constexpr double kRoundingSlack = 0.01;
// Powers of two: 4 voxels for a fine cell, a tile's 8 for a coarse one.
constexpr double kMostLevels = 2;

/// 1, 2 or 4: a tile of 8 voxels then holds whole cells of both sizes. A cell of a surface has the
/// square of its edge in voxels.
int voxels_per_fine_cell(const FeatureConfig& config, double resolution_m, std::size_t voxels) {
  const double levels = std::floor(std::log2(config.fine_cell_m / resolution_m) + kRoundingSlack);
  const double crowded = 0.5 * std::log2(static_cast<double>(voxels) / static_cast<double>(config.most_cells));
  return 1 << static_cast<int>(std::clamp(std::max(levels, std::ceil(crowded)), 0.0, kMostLevels));
}

template <class Entropy>
double mean_over(std::span<const Voxel> voxels, const Entropy& entropy) {
  double sum = 0;
  for (const Voxel& v : voxels) sum += entropy(static_cast<double>(v.occupancy));
  return voxels.empty() ? 0 : sum / static_cast<double>(voxels.size());
}

double weighted_log(double p) { return p > 0 ? -p * std::log2(p) : 0; }

}  // namespace

MapFeatures::MapFeatures(const mapping::SemanticOcTree& map, int voxels_per_fine_cell, int min_normal_voxels)
    : map_(&map),
      fine_grid_(voxels_per_fine_cell, static_cast<float>(map.getResolution()), min_normal_voxels),
      coarse_grid_(2 * voxels_per_fine_cell, static_cast<float>(map.getResolution()), min_normal_voxels) {}

Result<MapFeatures> MapFeatures::build(const mapping::SemanticOcTree& map, const FeatureConfig& config) {
  const auto voxels = occupied_voxels(map);
  if (!voxels) return voxels.error();
  MapFeatures features(map, voxels_per_fine_cell(config, map.getResolution(), voxels->size()),
                       config.min_normal_voxels);
  for (auto from = voxels->begin(); from != voxels->end();) {
    const mapping::TileKey tile = tile_of(*from);
    const auto to = std::find_if(from, voxels->end(), [&](const Voxel& v) { return tile_of(v) != tile; });
    features.fine_grid_.add_tile({from, to});
    features.coarse_grid_.add_tile({from, to});
    from = to;
  }
  features.finish();
  return features;
}

void MapFeatures::update(std::span<const mapping::TileKey> changed) {
  for (const mapping::TileKey tile : changed) replace(tile, occupied_voxels(*map_, tile));
  finish();
}

void MapFeatures::replace(mapping::TileKey tile, std::span<const Voxel> voxels) {
  fine_grid_.replace_tile(tile, voxels);
  coarse_grid_.replace_tile(tile, voxels);
}

void MapFeatures::finish() {
  fine_grid_.refresh();
  coarse_grid_.refresh();
  fine_ = fine_grid_.surfels();
  coarse_ = coarse_grid_.surfels();
}

double book_map_entropy(std::span<const Voxel> voxels) { return mean_over(voxels, weighted_log); }

}  // namespace cairn::matching
