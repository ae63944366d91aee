// SPDX-License-Identifier: Apache-2.0
// Packets → scans → odometry, CPU time of the thread, every scan measured by itself. Counters: ours_ms, p99_ms and
// max_ms of the odometry's update (deskewing included), decode_ms of the scan's packets (both medians and tails over n
// scans); drift_percent of the way at its end and lost scans say whether the work was done. deskew: a whole scan
// against the exact motion of every point, which is its peer.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "drivers/velodyne/lidar.hpp"
#include "hal/clock.hpp"
#include "onboard/odometry/estimation/deskew.hpp"
#include "onboard/odometry/odometry.hpp"
#include "tests/support/kitti.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn::odometry {
namespace {

const SE3 kMount = SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished());
constexpr double kSeconds = 20;

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

template <class Work>
double cpu_ms(Work&& work) {
  const Duration before = thread_cpu_time();
  work();
  return to_milliseconds(thread_cpu_time() - before);
}

/// The odometry as the robot has it, with a stop-watch.
class Timed {
 public:
  explicit Timed(const SE3& T_base_lidar) : odometry_({}, T_base_lidar, workers_) {}

  const OdometryUpdate& update(const Scan& scan) {
    Budget budget = Budget::steps(most_steps({}));
    const SE3 before = last_.T_odom_base.mean;
    ms_.push_back(cpu_ms([&] { last_ = odometry_.update(scan, budget).value(); }));
    way_m_ += (before.inverse() * last_.T_odom_base.mean).translation().norm();
    lost_ += last_.lost ? 1 : 0;
    points_ += scan.cloud.size();
    return last_;
  }
  void report(benchmark::State& state) const {
    const auto n = static_cast<double>(ms_.size());
    state.counters["n"] = n;
    state.counters["points"] = static_cast<double>(points_) / n;
    state.counters["ours_ms"] = quantile(ms_, 0.5);
    state.counters["p99_ms"] = quantile(ms_, 0.99);
    state.counters["max_ms"] = quantile(ms_, 1.0);
    state.counters["lost"] = lost_;
    state.counters["way_m"] = way_m_;
  }
  [[nodiscard]] const OdometryUpdate& last() const { return last_; }
  [[nodiscard]] double way_m() const { return way_m_; }

 private:
  Workers workers_{1};
  LidarOdometry odometry_;
  OdometryUpdate last_;
  std::vector<double> ms_;
  double way_m_ = 0, lost_ = 0;
  std::size_t points_ = 0;
};

void ride(benchmark::State& state, const support::Scene& scene) {
  const support::Vlp16Drive drive(scene, kMount, kSeconds, 1);
  for (auto _ : state) {
    Monitor monitor;
    const auto lidar = velodyne::Lidar::create({}, SourceId{}, monitor).value();
    Timed odometry(kMount);
    std::vector<double> decode_ms;
    std::optional<SE3> T_world_odom;
    double decoding = 0;
    for (const Packet& packet : drive.packets()) {
      const Scan* scan = nullptr;
      decoding += cpu_ms([&] { scan = lidar->decode(packet).value(); });
      if (scan == nullptr) continue;
      decode_ms.push_back(decoding);
      decoding = 0;
      odometry.update(*scan);
      if (!T_world_odom) T_world_odom = drive.truth(scan->valid.end);
    }
    const SE3 truth = T_world_odom->inverse() * drive.truth(odometry.last().stamp);
    const double drift_m = (odometry.last().T_odom_base.mean.translation() - truth.translation()).norm();
    odometry.report(state);
    state.counters["drift_percent"] = 100 * drift_m / odometry.way_m();
    state.counters["decode_ms"] = quantile(decode_ms, 0.5);
    state.counters["decode_p99_ms"] = quantile(decode_ms, 0.99);
    state.counters["decode_max_ms"] = quantile(decode_ms, 1.0);
  }
}

void street(benchmark::State& state) {
  std::vector<Scan> sweeps;
  while (auto sweep = support::kitti_sweep(support::recorded_data("kitti/street22"), static_cast<int>(sweeps.size())))
    sweeps.push_back(std::move(*sweep));
  if (sweeps.empty()) return state.SkipWithError("no recording");
  for (auto _ : state) {
    Timed odometry({});
    for (const Scan& sweep : sweeps) odometry.update(sweep);
    odometry.report(state);
  }
}

void deskew(benchmark::State& state) {
  const support::Scene scene = support::lobby();
  const support::RidePath path(scene.ride, 5);
  const Scan scan = support::Vlp16(kMount, 0.02, 1).scan(scene.world, path, 4);
  const double duration = to_seconds(scan.valid.end - scan.valid.start);
  const Vector6 twist = (Vector6() << 1.5, 0, 0, 0, 0, 0.8).finished();
  const std::size_t n = scan.cloud.size();
  std::vector<Eigen::Vector3f> ours(n), exact(n);
  std::vector<double> ours_ms, peer_ms;
  const auto age = [&](std::size_t i) { return duration - 1e-9 * scan.cloud.offset_ns[i]; };
  for (auto _ : state) {
    ours_ms.push_back(cpu_ms([&] {
      const Deskew moved(twist, kMount, duration);
      for (std::size_t i = 0; i < n; ++i) ours[i] = moved(scan.cloud.xyz[i], static_cast<float>(age(i)));
    }));
    peer_ms.push_back(cpu_ms([&] {
      for (std::size_t i = 0; i < n; ++i)
        exact[i] = (SE3::exp(-age(i) * twist) * (kMount * scan.cloud.xyz[i].cast<double>())).cast<float>();
    }));
  }
  float worst = 0;
  for (std::size_t i = 0; i < n; ++i) worst = std::max(worst, (ours[i] - exact[i]).norm());
  state.SetLabel("peer: exact motion of every point");
  state.counters["n"] = static_cast<double>(state.iterations());
  state.counters["points"] = static_cast<double>(n);
  state.counters["ours_ms"] = quantile(ours_ms, 0.5);
  state.counters["p99_ms"] = quantile(ours_ms, 0.99);
  state.counters["max_ms"] = quantile(ours_ms, 1.0);
  state.counters["peer_ms"] = quantile(peer_ms, 0.5);
  state.counters["ratio"] = quantile(peer_ms, 0.5) / quantile(ours_ms, 0.5);
  state.counters["worst_mm"] = 1e3 * static_cast<double>(worst);
}

BENCHMARK(deskew)->Name("deskew/lobby_vlp16")->Iterations(100)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ride, lobby, support::lobby())
    ->Name("odometry/lobby_vlp16")
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ride, forest, support::forest())
    ->Name("odometry/forest_vlp16")
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(street)->Name("odometry/street22_hdl64")->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cairn::odometry

BENCHMARK_MAIN();
