// SPDX-License-Identifier: Apache-2.0
// Packets → scans, whole: checks, device time, points, cut. `times_real_time` is the time that the packets took to be
// measured over the CPU time that decoding took; every laser has a return, which is the worst case.
#include <benchmark/benchmark.h>

#include <vector>

#include "drivers/velodyne/lidar.hpp"
#include "tests/support/velodyne_encoder.hpp"

namespace {

using namespace cairn;
using namespace cairn::velodyne;

/// A second of packets, made before the clock starts.
std::vector<Packet> second_of_packets(const Model& model, ReturnMode mode) {
  test::Sensor sensor;
  sensor.model = &model;
  sensor.mode = mode;
  sensor.scene = [](double azimuth, int channel) {
    return DataPacket::Return{static_cast<std::uint16_t>(1000 + azimuth * 20 + channel),
                              static_cast<std::uint8_t>(channel)};
  };
  std::vector<Packet> packets;
  while (sensor.device_ns < 1'000'000'000) packets.push_back(sensor.next());
  return packets;
}

void decode(benchmark::State& state, const char* name, ReturnMode mode) {
  const Model& model = *find_model(name);
  Config config;
  config.model = name;
  config.max_range_m = 300;
  Monitor monitor;
  const auto lidar = Lidar::create(config, SourceId{}, monitor).value();
  std::vector<Packet> packets = second_of_packets(model, mode);
  const Duration length = static_cast<int>(packets.size()) * model.packet_span(mode == ReturnMode::kDual);
  std::size_t points = 0;
  for (auto _ : state) {
    for (Packet& packet : packets) {
      const auto scan = lidar->decode(packet);
      if (scan && *scan != nullptr) points += (*scan)->cloud.size();
      // The same second again, later.
      const auto us = load_le<std::uint32_t>(packet.payload(), kTimestampOffset);
      test::store_le(packet.bytes, kTimestampOffset,
                     static_cast<std::uint32_t>((us + length.count() / 1000) % kMicrosecondsPerHour));
      packet.arrival += length;
    }
  }
  const auto runs = static_cast<double>(state.iterations());
  if (lidar->counters().data_packets != lidar->counters().packets) state.SkipWithError("packets were refused");
  state.counters["times_real_time"] = benchmark::Counter(runs * to_seconds(length), benchmark::Counter::kIsRate);
  state.counters["points_per_s"] = benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
  state.counters["ns_per_point"] =
      benchmark::Counter(static_cast<double>(points) * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(decode, vlp16_single, "VLP-16", ReturnMode::kStrongest)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode, vlp16_dual, "VLP-16", ReturnMode::kDual)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode, hdl32_single, "HDL-32E", ReturnMode::kStrongest)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode, vlp32c_single, "VLP-32C", ReturnMode::kStrongest)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode, vlp32c_dual, "VLP-32C", ReturnMode::kDual)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
