// SPDX-License-Identifier: Apache-2.0
// Merging two maps of about 60 k occupied voxels each, free space included; and the slices in which a team's map is
// kept, with memory locked as the onboard program has it.
#include <benchmark/benchmark.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <vector>

#include "fusion/merging/merge.hpp"
#include "fusion/merging/team_map.hpp"
#include "hal/clock.hpp"
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
using Tiles = std::vector<std::pair<mapping::TileKey, mapping::TileState>>;
Tiles tiles_of(const mapping::SemanticOcTree& map) {
  Tiles tiles;
  for (const mapping::TileKey key : mapping::known_tiles(map, 1U << 20U))
    tiles.emplace_back(key, mapping::read_tile(map, key));
  return tiles;
}

constexpr std::uint64_t kRobots = 8;

/// Pairs of robots in places of their own; `creep` moves one of each pair a little.
SubmapPoses poses_of(const SE3& T_a_b, int creep) {
  const SE3 step = SE3::from_xyz_rpy((Vector6() << 0.02 * creep, 0.01 * creep, 0, 0, 0, 0.002 * creep).finished());
  SubmapPoses poses;
  for (std::uint64_t robot = 1; robot <= kRobots; ++robot) {
    const Vector6 place = (Vector6() << 30.0 * static_cast<double>((robot - 1) / 2), 0, 0, 0, 0, 0).finished();
    poses[{robot, 0}] = SE3::from_xyz_rpy(place) * (robot % 2 == 1 ? SE3() : T_a_b * step);
  }
  return poses;
}

/// The robots' tiles come five at a time; every two hundred slices they are found to lie elsewhere.
void keep_team_map(const std::array<Tiles, 2>& tiles, const SE3& T_a_b, std::vector<double>& slices_ms) {
  const LiveClock clock;
  TeamMap map(0.2, Policy::kRelativeEntropy);
  for (std::size_t i = 0, slice = 0; i < tiles[0].size() || !map.up_to_date(); i += 5, ++slice) {
    for (std::size_t k = i; k < i + 5; ++k)
      for (std::uint64_t robot = 1; robot <= kRobots; ++robot)
        if (const auto& own = tiles[(robot - 1) % 2]; k < own.size())
          map.put({robot, 0}, own[k].first, own[k].second, Time{});
    if (slice % 200 == 0) map.place(poses_of(T_a_b, static_cast<int>(slice / 200)));
    const Duration begin = thread_cpu_time();
    Budget budget = Budget::until(clock.now() + std::chrono::microseconds(1500), clock, 100);
    (void)map.fuse(budget);
    slices_ms.push_back(to_milliseconds(thread_cpu_time() - begin));
  }
}

void BM_TeamMapSlices(benchmark::State& state) {
  const bool locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  const auto pair = support::two_robots(support::lobby(), {0, 3.4, 30}, {2.2, 5.6, 30}, 1, 2.0, 0.2);
  const std::array<Tiles, 2> tiles{tiles_of(*pair.a), tiles_of(*pair.b)};
  std::vector<double> slices_ms;
  for (auto _ : state) keep_team_map(tiles, pair.T_a_b, slices_ms);
  std::ranges::sort(slices_ms);
  const auto at = [&](double p) {
    return slices_ms[static_cast<std::size_t>(p * static_cast<double>(slices_ms.size() - 1))];
  };
  state.counters["locked"] = locked;
  state.counters["slices"] = static_cast<double>(slices_ms.size());
  state.counters["p99_ms"] = at(0.99);
  state.counters["p999_ms"] = at(0.999);
  state.counters["max_ms"] = slices_ms.back();
  munlockall();
}
BENCHMARK(BM_TeamMapSlices)->Unit(benchmark::kMillisecond)->Iterations(20);

BENCHMARK(BM_Merge)->ArgName("turned")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cairn::merging

BENCHMARK_MAIN();
