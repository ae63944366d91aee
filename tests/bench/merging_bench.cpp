// SPDX-License-Identifier: Apache-2.0
// Merging two maps of about 60 k occupied voxels each, free space included.
#include <benchmark/benchmark.h>

#include "fusion/merging/merge.hpp"
#include "tests/support/map_pairs.hpp"

namespace cairn::merging {
namespace {

void BM_Merge(benchmark::State& state) {
  auto pair = support::two_robots(support::lobby(), {0, 3.4, 30}, {2.2, 5.6, 30}, 1);
  Contributions team;
  team[1] = {1, std::move(pair.a), {}};
  team[2] = {1, std::move(pair.b), state.range(0) != 0 ? pair.T_a_b : SE3()};
  std::size_t nodes = 0;
  for (auto _ : state) nodes = (*merge(team))->size();
  state.counters["nodes"] = static_cast<double>(nodes);
}
BENCHMARK(BM_Merge)->ArgName("turned")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cairn::merging

BENCHMARK_MAIN();
