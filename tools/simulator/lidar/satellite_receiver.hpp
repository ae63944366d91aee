// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

#include "tools/simulator/motion/track.hpp"

namespace cairn::simulator {

/// A satellite receiver that speaks NMEA through the LiDAR. The world's origin is at kLatitude_deg, kLongitude_deg.
/// Its error is an offset that wanders within minutes, and a little noise from second to second.
class SatelliteReceiver {
 public:
  static constexpr double kLatitude_deg = 51.924, kLongitude_deg = 4.402;

  /// `sigma_m`: of each coordinate; 0: it has no antenna, and says that it is at the origin. `track` must outlive it.
  SatelliteReceiver(const Track& track, double sigma_m, std::int64_t start_utc_ns, std::uint64_t seed);

  /// The $GPRMC sentence of the last whole second of UTC.
  [[nodiscard]] std::string sentence(Time t) const;

 private:
  [[nodiscard]] std::string place_text(std::int64_t utc_s) const;
  [[nodiscard]] Eigen::Vector2d place(std::int64_t utc_s) const;

  struct Wave {
    double amplitude_m = 0, period_s = 1, phase = 0;
  };
  const Track& track_;
  double sigma_m_;
  std::int64_t start_utc_ns_;
  std::uint64_t seed_;
  std::array<std::array<Wave, 3>, 2> waves_{};  // of x and y
};

}  // namespace cairn::simulator
