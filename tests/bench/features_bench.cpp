// SPDX-License-Identifier: Apache-2.0
// What matching prepares of a map of about 65 k occupied voxels: all at once, and after a scan changed some of it.
#include <benchmark/benchmark.h>

#include "fusion/matching/features/map_features.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::matching {
namespace {

const mapping::SemanticOcTree& lobby() {
  static const auto map = support::two_robots(support::lobby(), {0, 3.4, 30}, {2.2, 5.6, 2}, 1).a;
  return *map;
}

void BM_Build(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(MapFeatures::build(lobby()));
}
BENCHMARK(BM_Build)->Unit(benchmark::kMillisecond);

void BM_Update(benchmark::State& state) {
  auto features = MapFeatures::build(lobby());
  std::vector<mapping::TileKey> tiles;
  const auto voxels = occupied_voxels(lobby());
  for (const Voxel& v : *voxels) {
    if (tiles.size() == static_cast<std::size_t>(state.range(0))) break;
    if (tiles.empty() || tiles.back() != tile_of(v)) tiles.push_back(tile_of(v));
  }
  for (auto _ : state) features->update(tiles);
}
BENCHMARK(BM_Update)->ArgName("tiles")->Arg(16)->Arg(64)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cairn::matching

BENCHMARK_MAIN();
