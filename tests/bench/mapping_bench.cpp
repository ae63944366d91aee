// SPDX-License-Identifier: Apache-2.0
// Scan insertion against octomap::OcTree::insertPointCloud(discretize) in the same run, CPU time of the thread, and the
// proof that both trees are equal. Counters: ours_ms and peer_ms are medians over n scans, ours_p95_ms and ours_max_ms
// the tail, differing_voxels counts nodes (inner ones included) over all comparisons, allocations those of the second
// half of the scans.
#include <benchmark/benchmark.h>
#include <octomap/octomap.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "hal/clock.hpp"
#include "onboard/mapping/mapper.hpp"
#include "tests/onboard/mapping/kitti_scans.hpp"
#include "tests/onboard/mapping/scan_yard.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"
#include "tests/support/allocation_count.hpp"

namespace cairn::mapping {
namespace {

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values.empty() ? 0.0 : values[std::min(at, values.size() - 1)];
}

template <class Work>
double cpu_ms(Work&& work) {
  const Duration before = thread_cpu_time();
  work();
  return to_milliseconds(thread_cpu_time() - before);
}

octomap::Pointcloud to_octomap(const MapScan& scan) {
  octomap::Pointcloud cloud;
  cloud.reserve(scan.points.size());
  for (const Eigen::Vector3f& p : scan.points) cloud.push_back(p.x(), p.y(), p.z());
  return cloud;
}

struct Case {
  double resolution, max_range;
  int compare_every;            // scans; 0: never, and no peer
  bool spare_surfaces = false;  // then the map is not OctoMap's
};

struct Comparison {
  std::vector<double> ours, peer;
  std::size_t differing = 0, points = 0, warm_allocations = 0;
  double ours_mb = 0, peer_mb = 0;
  bool identical = true;
};

/// Both inserters over the scans in lock step, into trees that are made here.
void run_once(benchmark::State& state, const std::vector<MapScan>& scans, const Case& c, Workers& workers,
              Comparison& found) {
  MappingConfig config;
  config.resolution_m = c.resolution;
  config.max_range_m = c.max_range;
  config.spare_surfaces = c.spare_surfaces;
  config.reserve_mb = 96;
  double resident = resident_mb();
  Mapper mapper(config, workers);
  octomap::OcTree stock(c.resolution);
  found.ours_mb = resident_mb() - resident;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    found.points += scans[i].points.size();
    resident = resident_mb();
    const std::size_t before = support::allocation_count();
    found.ours.push_back(cpu_ms([&] { benchmark::DoNotOptimize(mapper.insert(scans[i].points, scans[i].origin)); }));
    if (i >= scans.size() / 2) found.warm_allocations += support::allocation_count() - before;
    found.ours_mb += resident_mb() - resident;
    if (c.compare_every == 0) continue;
    const octomap::Pointcloud cloud = to_octomap(scans[i]);
    const octomap::point3d origin(scans[i].origin.x(), scans[i].origin.y(), scans[i].origin.z());
    resident = resident_mb();
    found.peer.push_back(cpu_ms([&] { stock.insertPointCloud(cloud, origin, c.max_range, false, true); }));
    found.peer_mb += resident_mb() - resident;
    if ((i + 1) % static_cast<std::size_t>(c.compare_every) == 0 || i + 1 == scans.size())
      found.differing += differing_nodes(mapper.tree(), stock);
  }
  if (c.compare_every != 0) found.identical = data_of(mapper.tree()) == data_of(stock);
  state.counters["nodes"] = static_cast<double>(mapper.tree().size());
  state.counters["used_mb"] = static_cast<double>(mapper.tree().used_bytes()) / 1048576.0;
}

void compare(benchmark::State& state, const std::vector<MapScan>& scans, const Case& c) {
  if (scans.empty()) return state.SkipWithError("no recording");
  Workers workers(1);
  Comparison found;
  for (auto _ : state) run_once(state, scans, c, workers, found);
  state.counters["n"] = static_cast<double>(scans.size());
  state.counters["points"] = static_cast<double>(found.points) / static_cast<double>(scans.size());
  state.counters["ours_ms"] = quantile(found.ours, 0.5);
  state.counters["ours_p95_ms"] = quantile(found.ours, 0.95);
  state.counters["ours_max_ms"] = quantile(found.ours, 1.0);
  state.counters["ours_resident_mb"] = found.ours_mb;
  state.counters["allocations"] = static_cast<double>(found.warm_allocations);
  if (c.compare_every == 0) return;
  state.counters["peer_ms"] = quantile(found.peer, 0.5);
  state.counters["peer_resident_mb"] = found.peer_mb;
  state.counters["ratio"] = quantile(found.peer, 0.5) / quantile(found.ours, 0.5);
  state.counters["differing_voxels"] = static_cast<double>(found.differing);
  state.counters["data_identical"] = found.identical ? 1 : 0;
}

std::vector<MapScan> yard(int scans) {
  const ScanYard world;
  std::vector<MapScan> out;
  for (int i = 0; i < scans; ++i) out.push_back(world.scan(i));
  return out;
}

void add(const char* name, std::vector<MapScan> (*scans)(int), int count, const Case& c) {
  benchmark::RegisterBenchmark(name, [=](benchmark::State& state) { compare(state, scans(count), c); })
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace cairn::mapping

int main(int argc, char** argv) {
  using namespace cairn;
  mapping::add("insert/yard_vlp16/0.1m/30m", mapping::yard, 30, {0.1, 30, 1});
  mapping::add("insert/yard_vlp16/0.2m/30m", mapping::yard, 30, {0.2, 30, 1});
  mapping::add("insert/kitti_hdl64/0.1m/30m", mapping::kitti_scans, 16, {0.1, 30, 1});
  mapping::add("insert/kitti_hdl64/0.2m/30m", mapping::kitti_scans, 16, {0.2, 30, 1});
  mapping::add("insert_long/yard_vlp16/0.1m/30m/300", mapping::yard, 300, {0.1, 30, 10});
  mapping::add("insert_alone/yard_vlp16/0.1m/30m", mapping::yard, 100, {0.1, 30, 0});
  mapping::add("insert_spared/yard_vlp16/0.1m/30m", mapping::yard, 100, {0.1, 30, 0, true});
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
