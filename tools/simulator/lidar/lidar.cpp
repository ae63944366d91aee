// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/lidar/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr std::uint64_t kClockStream = 10, kShotStream = 11;
constexpr std::uint64_t kMostPanes = 4, kPaneStreams = 1000;  // of clear glass, one behind the other
constexpr double kNearest = 0.01, kBehind = 1e-4;             // m; where a ray begins, and behind a pane

template <class T, std::size_t N>
void store_le(std::array<std::byte, N>& bytes, std::size_t offset, T value) {
  static_assert(sizeof(T) <= N);
  std::memcpy(bytes.data() + offset, &value, sizeof(T));
}

}  // namespace

Lidar::Lidar(const velodyne::Model& model, const Tracer& tracer, const Track& track, const LidarConfig& config,
             std::int64_t start_utc_ns, std::uint64_t seed, const Crowd* people)
    : model_(model),
      tracer_(tracer),
      track_(track),
      config_(config),
      T_base_sensor_(SE3::from_xyz_rpy(config.base_sensor_xyz_rpy)),
      start_utc_ns_(start_utc_ns),
      seed_(seed),
      people_(people),
      receiver_(track, config.satellites_sigma_m, start_utc_ns, seed) {
  Random random(seed, kClockStream);
  first_azimuth_ = random.uniform(0.0, 2.0 * kPi);
  device_start_us_ =
      static_cast<std::int64_t>(random.uniform(0.0, static_cast<double>(velodyne::kMicrosecondsPerHour)));
  for (std::size_t c = 0; c < static_cast<std::size_t>(model.channel_count); ++c) {
    const velodyne::Channel& channel = model.channels[c];
    beams_[c] = {std::cos(channel.elevation_deg * kDegree), std::sin(channel.elevation_deg * kDegree),
                 channel.vertical_offset_m, channel.rotation_correction_deg * kDegree};
  }
}

Time Lidar::first_firing(std::uint64_t n) const {
  return track_.start() + model_.packet_span(false) * static_cast<std::int64_t>(n);
}

Time Lidar::arrival(std::uint64_t n) const {
  return first_firing(n) + model_.firing_offset(velodyne::kBlocks - 1, velodyne::kBlockChannels - 1, false) +
         config_.latency;
}

double Lidar::azimuth(Time t) const {
  const double turns = config_.rotation_hz * to_seconds(t - track_.start());
  return first_azimuth_ + 2.0 * kPi * (turns - std::floor(turns));
}

std::uint32_t Lidar::device_microseconds(Time t) const {
  const std::int64_t since_ns = (t - track_.start()).count();
  const std::int64_t us = config_.pps ? (start_utc_ns_ + since_ns) / 1000 : device_start_us_ + since_ns / 1000;
  return static_cast<std::uint32_t>(us % velodyne::kMicrosecondsPerHour);
}

int Lidar::fill(std::uint64_t n, DataPacket& packet, Labels* labels) const {
  packet.fill(std::byte{0});
  const Time first = first_firing(n);
  int returns = 0;
  for (int block = 0; block < velodyne::kBlocks; ++block) {
    const std::size_t base = static_cast<std::size_t>(block) * velodyne::kBlockBytes;
    const double units = azimuth(first + model_.firing_offset(block, 0, false)) / (kDegree * velodyne::kAzimuthUnitDeg);
    store_le(packet, base + velodyne::kBlockFlagOffset, velodyne::kBlockFlag);
    store_le(packet, base + velodyne::kBlockAzimuthOffset,
             static_cast<std::uint16_t>(std::lround(units) % velodyne::kAzimuthUnits));
    for (int slot = 0; slot < velodyne::kBlockChannels; ++slot) {
      const std::uint64_t shot =
          (n * velodyne::kBlocks + static_cast<std::uint64_t>(block)) * velodyne::kBlockChannels +
          static_cast<std::uint64_t>(slot);
      const Time t = first + model_.firing_offset(block, slot, false);
      const Echo echo = shoot(t, static_cast<std::size_t>(slot % model_.channel_count), shot);
      const std::size_t at =
          base + velodyne::kBlockReturnsOffset + static_cast<std::size_t>(slot) * velodyne::kReturnBytes;
      store_le(packet, at, echo.distance);
      store_le(packet, at + 2, echo.reflectivity);
      if (labels != nullptr)
        (*labels)[static_cast<std::size_t>(block * velodyne::kBlockChannels + slot)] = echo.class_id;
      returns += echo.distance != 0 ? 1 : 0;
    }
  }
  store_le(packet, velodyne::kTimestampOffset, device_microseconds(first));
  store_le(packet, velodyne::kReturnModeOffset, static_cast<std::uint8_t>(velodyne::ReturnMode::kStrongest));
  store_le(packet, velodyne::kProductOffset, model_.product);
  return returns;
}

Lidar::Echo Lidar::shoot(Time t, std::size_t channel, std::uint64_t shot) const {
  const Beam& beam = beams_[channel];
  const double alpha = azimuth(t) - beam.rotation_correction;  // clockwise seen from above, 0 = ahead
  const Eigen::Vector3d direction(beam.cos_elevation * std::cos(alpha), -beam.cos_elevation * std::sin(alpha),
                                  beam.sin_elevation);
  const SE3 T_world_sensor = track_.T_world_base(t) * T_base_sensor_;
  const Ray ray{T_world_sensor * Eigen::Vector3d(0, 0, beam.vertical_offset), T_world_sensor.quaternion() * direction};
  double nearest = kNearest, through = 1;
  for (std::uint64_t panes = 0; panes <= kMostPanes; ++panes) {
    auto hit = tracer_.trace(ray, nearest, config_.max_range_m);
    if (people_ != nullptr) {
      if (const auto body = people_->trace(ray, t, hit ? hit->distance : config_.max_range_m)) hit = body;
    }
    if (!hit || hit->distance < config_.min_range_m) return {};
    const Echo echo = receive(*hit, through, panes, shot);
    const double passed = transmission(hit->material, hit->cos_incidence);
    if (echo.distance != 0 || passed == 0) return echo;
    nearest = hit->distance + kBehind;
    through *= passed * passed;  // there and back
  }
  return {};
}

Lidar::Echo Lidar::receive(const Hit& hit, double through, std::uint64_t panes, std::uint64_t shot) const {
  const MaterialProperties& surface = properties(hit.material);
  Random random(seed_, kShotStream + panes * kPaneStreams, shot);
  if (random.uniform() < config_.dropout) return {};
  const double lit = surface.lobe == 1.0 ? hit.cos_incidence : std::pow(hit.cos_incidence, surface.lobe);
  // Received power over the power that is seen every other time; a smooth step between never and always.
  const double signal = through * surface.reflectivity * lit / 0.1 * std::pow(config_.half_range_m / hit.distance, 2);
  if (random.uniform() >= signal * signal / (1.0 + signal * signal)) return {};
  const auto [range_noise, intensity_noise] = random.normal_pair();
  const double distance = hit.distance + config_.range_noise_m * range_noise;
  const double raw = std::round(distance / model_.distance_unit_m);
  if (raw < 1.0 || raw > 65535.0) return {};
  // Diffuse surfaces report 0…100, retro-reflectors 101…255 (VLP-16 manual).
  const double brightness = 100.0 * surface.reflectivity * (surface.reflectivity > 1.0 ? 1.0 : 0.4 + 0.6 * lit);
  const double reported = brightness + config_.intensity_noise * intensity_noise;
  const double highest = surface.reflectivity > 1.0 ? 255.0 : 100.0;
  return {static_cast<std::uint16_t>(raw), static_cast<std::uint8_t>(std::lround(std::clamp(reported, 0.0, highest))),
          surface.class_id};
}

void Lidar::fill_position(Time t, PositionPacket& packet) const {
  packet.fill(std::byte{0});
  store_le(packet, velodyne::kTopBoardTemperatureOffset, std::int8_t{41});
  store_le(packet, velodyne::kBottomBoardTemperatureOffset, std::int8_t{38});
  store_le(packet, velodyne::kPositionTimestampOffset, device_microseconds(t));
  const auto state = config_.pps ? velodyne::PpsState::kLocked : velodyne::PpsState::kAbsent;
  store_le(packet, velodyne::kPpsStateOffset, static_cast<std::uint8_t>(state));
  if (!config_.pps) return;  // it has no receiver
  const std::string sentence = receiver_.sentence(t);
  std::memcpy(packet.data() + velodyne::kNmeaOffset, sentence.data(), std::min(sentence.size(), velodyne::kNmeaBytes));
}

}  // namespace cairn::simulator
