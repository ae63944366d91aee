// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/scenes.hpp"
#include "tests/support/velodyne_encoder.hpp"

namespace cairn::support {

/// What a VLP-16 on a base that rides through a scene sends: packets, so that decoding takes part.
class Vlp16Drive {
 public:
  Vlp16Drive(const Scene& scene, SE3 T_base_lidar, double seconds, unsigned seed)
      : world_(scene.world), path_(scene.ride, seconds + 1), T_base_lidar_(std::move(T_base_lidar)), random_(seed) {
    sensor_.scene = [this](double azimuth_deg, int channel) { return shoot(azimuth_deg, channel); };
    while (1e-9 * static_cast<double>(sensor_.device_ns) < seconds) packets_.push_back(sensor_.next());
  }
  Vlp16Drive(const Vlp16Drive&) = delete;
  Vlp16Drive& operator=(const Vlp16Drive&) = delete;

  [[nodiscard]] const std::vector<Packet>& packets() const { return packets_; }
  [[nodiscard]] SE3 truth(Time t) const { return path_(to_seconds(t - sensor_.start)); }

 private:
  velodyne::DataPacket::Return shoot(double azimuth_deg, int channel) {
    const double since_packet = std::fmod(azimuth_deg - sensor_.azimuth_deg + 360.0, 360.0) / sensor_.rate_deg_s;
    const SE3 T_world_lidar = path_(1e-9 * static_cast<double>(sensor_.device_ns) + since_packet) * T_base_lidar_;
    const velodyne::Channel& laser = sensor_.model->channels[static_cast<std::size_t>(channel)];
    constexpr double kRadians = std::numbers::pi / 180;
    const double azimuth = -kRadians * azimuth_deg, elevation = kRadians * laser.elevation_deg;
    const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                    std::sin(elevation));
    const Eigen::Vector3d origin = T_world_lidar * Eigen::Vector3d(0, 0, laser.vertical_offset_m);
    const double range = world_.cast(origin, T_world_lidar.rotation() * direction) + noise_(random_);
    if (!(range > 0.5 && range < 100)) return {0, 0};
    return {static_cast<std::uint16_t>(std::lround(range / sensor_.model->distance_unit_m)), 100};
  }

  World world_;
  RidePath path_;
  SE3 T_base_lidar_;
  std::mt19937 random_;
  std::normal_distribution<double> noise_{0, 0.02};
  velodyne::test::Sensor sensor_;
  std::vector<Packet> packets_;
};

}  // namespace cairn::support
