// SPDX-License-Identifier: Apache-2.0
// What labels cost beside geometry: in the same run each scan is inserted, and then all of its points are labelled, as
// if the cameras saw all around. CPU time of one thread. ours_ms is the label update, peer_ms the insertion; bytes are
// those of the map's nodes, with labels and without.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "hal/clock.hpp"
#include "onboard/mapping/mapper.hpp"
#include "tests/onboard/mapping/kitti_scans.hpp"
#include "tests/onboard/mapping/scan_yard.hpp"

namespace cairn::mapping {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[values.size() / 2];
}

template <class Work>
double cpu_ms(Work&& work) {
  const Duration before = thread_cpu_time();
  work();
  return to_milliseconds(thread_cpu_time() - before);
}

/// A class for each quarter of a metre of height: more borders than a street has.
std::vector<LabelledPoint> labelled(const std::vector<Eigen::Vector3f>& points) {
  std::vector<LabelledPoint> out;
  for (const auto& p : points) {
    const auto storey = static_cast<int>((p.z() + 100) * 4);
    out.push_back({p, static_cast<std::uint8_t>(storey % 19), static_cast<std::uint8_t>(150 + storey % 100), 200});
  }
  return out;
}

void compare(benchmark::State& state, const std::vector<MapScan>& scans) {
  if (scans.empty()) return state.SkipWithError("no recording");
  MappingConfig config;
  config.reserve_mb = 96;
  Workers workers(1);
  std::vector<double> label_ms, insert_ms;
  std::size_t points = 0, voxels = 0;
  for (auto _ : state) {
    Mapper with(config, workers), without(config, workers);
    for (const MapScan& scan : scans) {
      const auto labels = labelled(scan.points);
      insert_ms.push_back(cpu_ms([&] { benchmark::DoNotOptimize(with.insert(scan.points, scan.origin)); }));
      label_ms.push_back(cpu_ms([&] { voxels += with.label(labels).voxels; }));
      benchmark::DoNotOptimize(without.insert(scan.points, scan.origin));
      points += labels.size();
    }
    state.counters["with_labels_mb"] = static_cast<double>(with.tree().used_bytes()) / 1048576.0;
    state.counters["without_mb"] = static_cast<double>(without.tree().used_bytes()) / 1048576.0;
  }
  state.counters["n"] = static_cast<double>(scans.size());
  state.counters["points"] = static_cast<double>(points) / static_cast<double>(scans.size());
  state.counters["voxels"] = static_cast<double>(voxels) / static_cast<double>(scans.size());
  state.counters["ours_ms"] = median(label_ms);
  state.counters["peer_ms"] = median(insert_ms);
  state.counters["ratio"] = median(insert_ms) / median(label_ms);
}

std::vector<MapScan> yard(int scans) {
  const ScanYard world;
  std::vector<MapScan> out;
  for (int i = 0; i < scans; ++i) out.push_back(world.scan(i));
  return out;
}

void add(const char* name, std::vector<MapScan> (*scans)(int), int count) {
  benchmark::RegisterBenchmark(name, [=](benchmark::State& state) { compare(state, scans(count)); })
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace cairn::mapping

int main(int argc, char** argv) {
  using namespace cairn;
  mapping::add("label/yard_vlp16/0.1m/30m", mapping::yard, 60);
  mapping::add("label/kitti_hdl64/0.1m/30m", mapping::kitti_scans, 16);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
