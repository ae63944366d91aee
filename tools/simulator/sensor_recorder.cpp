// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensor_recorder.hpp"

#include "drivers/gpio/estop.hpp"
#include "tools/simulator/sensors/switches.hpp"

namespace cairn::simulator {
namespace {

constexpr std::uint64_t kStereoStream = 30, kThermalStream = 31, kDepthStream = 32, kMotorStream = 33, kLineStream = 34;
constexpr Duration kTriggerPulse = std::chrono::milliseconds(1);

/// Calls shoot(n, t, packet) for every exposure and hands the packet on.
template <class Shoot>
Result<std::uint64_t> expose(const SensorRun& run, double rate_hz, const Sink& sink, Shoot&& shoot) {
  Packet packet;
  std::uint64_t n = 0;
  for (; exposure(kStart, rate_hz, n) < run.end; ++n) {
    const Time t = exposure(kStart, rate_hz, n);
    if (Result<void> done = shoot(n, t, packet); !done) return done.error();
    if (auto taken = sink(packet); !taken) return taken.error();
  }
  return n;
}

}  // namespace

Result<std::uint64_t> record_stereo(const SensorRun& run, const StereoConfig& config, const Sink& sink,
                                    const PictureTruth& truth, const Progress& progress) {
  const Stage& s = run.stage;
  const Stereo stereo(config, s.tracer, s.people, s.climate, run.trajectory, mix(run.seed ^ kStereoStream));
  std::vector<std::byte> classes;
  SeenPeople seen;
  return expose(run, config.rate_hz, sink, [&](std::uint64_t n, Time t, Packet& packet) -> Result<void> {
    stereo.shoot(n, t, run.workers, packet, classes, &seen);
    if (progress) progress(to_seconds(t - kStart) / to_seconds(run.end - kStart));
    return truth(t, classes, seen);
  });
}

Result<std::uint64_t> record_thermal(const SensorRun& run, const ThermalConfig& config, const Sink& sink,
                                     const ThermalTruth& truth) {
  const Stage& s = run.stage;
  SeenPeople seen;
  const ThermalCamera thermal(config, s.tracer, s.people, s.climate, run.trajectory, mix(run.seed ^ kThermalStream));
  return expose(run, config.rate_hz, sink, [&](std::uint64_t n, Time t, Packet& packet) -> Result<void> {
    thermal.shoot(n, t, run.workers, packet, &seen);
    truth(t, seen);
    return {};
  });
}

Result<std::uint64_t> record_depth(const SensorRun& run, const DepthConfig& config, const Sink& sink) {
  const DepthSensor depth(config, run.stage.tracer, run.stage.people, run.trajectory, mix(run.seed ^ kDepthStream));
  return expose(run, config.rate_hz, sink, [&](std::uint64_t n, Time t, Packet& packet) -> Result<void> {
    depth.shoot(n, t, run.workers, packet);
    return {};
  });
}

Result<std::uint64_t> record_motors(const SensorRun& run, const WheelConfig& config, const Sink& sink) {
  MotorBus bus(config, run.trajectory, mix(run.seed ^ kMotorStream));
  const Duration rearm = from_seconds(1e-3 * gpio::Config{}.estop_rearm_ms) + std::chrono::milliseconds(10);
  std::uint64_t frames = 0;
  while (bus.now() < run.end) {
    bus.tick(bus.now() >= kStart + kEStopReleased + rearm);
    for (const Packet& packet : bus.frames()) {
      if (packet.arrival < kStart || packet.arrival > run.end) continue;
      if (auto taken = sink(packet); !taken) return taken.error();
      ++frames;
    }
  }
  return frames;
}

Result<std::uint64_t> record_lines(const SensorRun& run, double trigger_hz, const Sink& sink) {
  Packet packet;
  for (const LineEdge& edge : line_edges(kStart, run.end, trigger_hz, kTriggerPulse, mix(run.seed ^ kLineStream))) {
    packet.arrival = edge.stamp;
    gpio::encode_event(edge.event, packet);
    if (auto taken = sink(packet); !taken) return taken.error();
    ++packet.sequence;
  }
  return packet.sequence;
}

}  // namespace cairn::simulator
