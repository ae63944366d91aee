// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/thermal_camera.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "drivers/camera/frame.hpp"
#include "drivers/thermal/telemetry.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

constexpr std::uint64_t kBootStream = 60, kFixedStream = 61, kNoiseStream = 62;
// Words of the telemetry (FLIR Lepton Engineering Datasheet, "Telemetry Modes"); row C begins at 160.
constexpr std::size_t kRevision = 0, kUptime = 1, kStatus = 3, kFrameCounter = 20, kSensor = 24, kHousing = 26,
                      kLastCorrection = 30, kTlinear = 208, kCentikelvin = 209;

void store16(std::byte* to, std::uint32_t value) {
  to[0] = static_cast<std::byte>(value & 0xFFU);
  to[1] = static_cast<std::byte>(value >> 8U & 0xFFU);
}

void store32(std::byte* to, std::uint32_t value) {
  store16(to, value & 0xFFFFU);
  store16(to + 2, value >> 16U);
}

}  // namespace

ThermalCamera::ThermalCamera(const ThermalConfig& config, const Tracer& tracer, const Crowd& people,
                             const Climate& climate, const Trajectory& trajectory, std::uint64_t seed)
    : config_(config),
      tracer_(tracer),
      people_(people),
      climate_(climate),
      trajectory_(trajectory),
      seed_(seed),
      uptime_at_start_(from_seconds(std::floor(Random(seed, kBootStream).uniform(200.0, 2000.0)))) {}

Duration ThermalCamera::uptime(Time t) const { return uptime_at_start_ + (t - trajectory_.start()); }

ThermalCamera::Correction ThermalCamera::correction(Time t) const {
  const Duration up = uptime(t), since = up % config_.correction_period;
  return {up - since, since < config_.correction_length};
}

void ThermalCamera::expose_row(const Instant& instant, const SE3& T_world_camera, int row, std::uint64_t frame,
                               std::uint64_t correction, std::byte* out, SeenPeople* people) const {
  std::vector<Sighting> seen(static_cast<std::size_t>(config_.lens.width));
  look(instant, config_.lens, T_world_camera, row, seen);
  if (people != nullptr) people->add_row(row, T_world_camera.translation(), seen, instant.people);
  Random noise(seed_, kNoiseStream ^ frame << 8U, static_cast<std::uint64_t>(row));
  Random fixed(seed_, kFixedStream ^ correction << 8U, static_cast<std::uint64_t>(row));
  for (const Sighting& s : seen) {
    const double kelvin = apparent_celsius(s, climate_, instant) + 273.15 +
                          config_.noise_k * noise.normal_pair().first +
                          config_.fixed_noise_k * fixed.normal_pair().first;
    store16(out, static_cast<std::uint32_t>(std::clamp(std::lround(100 * kelvin), 0L, 65535L)));
    out += 2;
  }
}

void ThermalCamera::append_telemetry(std::uint64_t n, Time t, std::vector<std::byte>& out) const {
  const auto milliseconds = [](Duration d) { return static_cast<std::uint32_t>(d.count() / 1'000'000); };
  const std::size_t bytes = static_cast<std::size_t>(2 * config_.lens.width * kTelemetryRows), first = out.size();
  out.resize(first + bytes, std::byte{0});
  const auto word = [&](std::size_t i) { return out.data() + first + 2 * i; };
  const Correction newest = correction(t);
  const auto state = newest.running ? thermal::FlatField::kRunning : thermal::FlatField::kComplete;
  const Duration ended = newest.running ? newest.began - config_.correction_period + config_.correction_length
                                        : newest.began + config_.correction_length;
  store16(word(kRevision), 0x000E);
  store32(word(kUptime), milliseconds(uptime(t)));
  store32(word(kStatus), static_cast<std::uint32_t>(state) << 4U);
  store32(word(kFrameCounter), static_cast<std::uint32_t>(n));
  store16(word(kSensor), static_cast<std::uint32_t>(std::lround(100 * (climate_.air_c + 9.0 + 273.15))));
  store16(word(kHousing), static_cast<std::uint32_t>(std::lround(100 * (climate_.air_c + 6.0 + 273.15))));
  store32(word(kLastCorrection), milliseconds(std::max(ended, Duration::zero())));
  store16(word(kTlinear), 1);
  store16(word(kCentikelvin), 1);
}

void ThermalCamera::shoot(std::uint64_t n, Time t, Workers& workers, Packet& packet, SeenPeople* seen) const {
  const auto width = static_cast<std::size_t>(config_.lens.width),
             height = static_cast<std::size_t>(config_.lens.height);
  packet.bytes.clear();
  camera::append_header(
      packet.bytes, {static_cast<std::uint32_t>(camera::FrameFormat::kY16), static_cast<std::uint32_t>(width),
                     static_cast<std::uint32_t>(height + kTelemetryRows), static_cast<std::uint32_t>(2 * width), true});
  packet.bytes.resize(camera::kFrameHeaderBytes + 2 * width * height);
  packet.arrival = t;
  packet.sequence = n;
  // While the shutter is closed the last picture stands still.
  const Correction newest = correction(t);
  const Time exposed = newest.running ? std::max(trajectory_.start(), t - (uptime(t) - newest.began)) : t;
  const std::uint64_t frame = newest.running ? static_cast<std::uint64_t>(exposed.time_since_epoch().count()) : n;
  const auto figures = people_.figures(exposed);
  const Instant instant{tracer_, figures};
  const SE3 T_world_camera = trajectory_.T_world_base(exposed) * SE3::from_xyz_rpy(config_.base_camera_xyz_rpy);
  if (seen != nullptr) seen->begin(people_.size(), config_.lens.height);
  workers.for_each(height, [&](std::size_t row) {
    expose_row(instant, T_world_camera, static_cast<int>(row), frame,
               static_cast<std::uint64_t>(newest.began / config_.correction_period),
               packet.bytes.data() + camera::kFrameHeaderBytes + 2 * width * row, seen);
  });
  append_telemetry(n, t, packet.bytes);
}

}  // namespace cairn::simulator
