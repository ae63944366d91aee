// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/velodyne/models.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "tools/simulator/lidar/satellite_receiver.hpp"
#include "tools/simulator/motion/track.hpp"
#include "tools/simulator/people/crowd.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::simulator {

struct LidarConfig {
  double rotation_hz = 10.0;
  double range_noise_m = 0.02;  ///< standard deviation
  double dropout = 0.01;        ///< share of returns lost whatever they hit
  double half_range_m = 60.0;   ///< where a 10 % diffuse surface, hit squarely, is seen every other time
  double min_range_m = 0.5;
  double max_range_m = 100.0;
  double intensity_noise = 2.0;                       ///< standard deviation, in units of the reflectivity byte
  Duration latency = std::chrono::microseconds(100);  ///< from the last firing of a packet to its arrival
  bool pps = false;               ///< true: the sensor's clock is UTC and it says so; false: it runs freely
  double satellites_sigma_m = 0;  ///< with pps: standard deviation of a receiver's place; 0: it does not tell its place
  Vector6 base_sensor_xyz_rpy = (Vector6() << 0.2, 0.0, 0.6, 0.0, 0.0, 0.0).finished();  ///< T_base_sensor
};

/// A Velodyne of a given model, single return, on a robot that moves while it fires. Each laser shot is traced from
/// where the sensor truly is at that very instant. A packet depends on its number alone, never on who asks when.
/// Point equation and vertical offsets as the decoder has them: the beam leaves the sensor's axis at the vertical
/// offset. Not modelled: the width of the beam (returns from edges mix two distances), rain, other sensors.
class Lidar {
 public:
  /// `model`, `tracer`, `track` and `people` (where there are any) must outlive it. `start_utc_ns` is the wall time at
  /// the track's start.
  Lidar(const velodyne::Model& model, const Tracer& tracer, const Track& track, const LidarConfig& config,
        std::int64_t start_utc_ns, std::uint64_t seed, const Crowd* people = nullptr);

  using DataPacket = std::array<std::byte, velodyne::kDataBytes>;
  using PositionPacket = std::array<std::byte, velodyne::kPositionBytes>;

  /// Data packets per position packet, as a real sensor sends them.
  static constexpr std::uint64_t kPositionEvery = 14;

  /// True trainIds of a data packet's returns, in the packet's order; kIgnoredClass where nothing returned.
  using Labels = std::array<std::uint8_t, velodyne::kBlocks * velodyne::kBlockChannels>;

  /// The n-th data packet; returns how many lasers got a return. Fills `labels` where given.
  int fill(std::uint64_t n, DataPacket& packet, Labels* labels = nullptr) const;
  [[nodiscard]] Time first_firing(std::uint64_t n) const;
  /// When packet n reaches the computer.
  [[nodiscard]] Time arrival(std::uint64_t n) const;

  /// What the sensor reports about its clock at `t`.
  void fill_position(Time t, PositionPacket& packet) const;

 private:
  struct Echo {
    std::uint16_t distance = 0;
    std::uint8_t reflectivity = 0;
    std::uint8_t class_id = kIgnoredClass;
  };
  struct Beam {  // what of a laser does not change while it turns
    double cos_elevation = 1, sin_elevation = 0, vertical_offset = 0, rotation_correction = 0;
  };

  [[nodiscard]] double azimuth(Time t) const;
  [[nodiscard]] std::uint32_t device_microseconds(Time t) const;
  [[nodiscard]] Echo shoot(Time t, std::size_t channel, std::uint64_t shot) const;
  /// `through`: share of the light that is left after `panes` of clear glass, there and back.
  [[nodiscard]] Echo receive(const Hit& hit, double through, std::uint64_t panes, std::uint64_t shot) const;

  const velodyne::Model& model_;
  const Tracer& tracer_;
  const Track& track_;
  LidarConfig config_;
  SE3 T_base_sensor_;
  std::int64_t start_utc_ns_;
  std::uint64_t seed_;
  const Crowd* people_;
  SatelliteReceiver receiver_;
  double first_azimuth_;          // radians, at the start
  std::int64_t device_start_us_;  // the sensor's free-running counter at the start
  std::array<Beam, velodyne::kBlockChannels> beams_{};
};

}  // namespace cairn::simulator
