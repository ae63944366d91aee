// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "drivers/drive/chassis/config.hpp"
#include "tools/simulator/world/random.hpp"

namespace cairn::simulator {

/// How wheels and ground disagree. All of it is unknown to whoever decodes the frames.
struct WheelConfig {
  double radius_error = 0.005;        ///< 1 σ of each side's wheel radius, as a share
  double separation_error = 0.03;     ///< 1 σ of the effective separation of skid steering, as a share
  double travel_noise_m = 0.008;      ///< 1 σ of one side's travel after 1 m
  double encoder_noise_counts = 1.0;  ///< 1 σ of every reading
  double spin_every_s = 20.0;         ///< mean time between two spins: one side turns much faster than it moves
};

/// The wheels as they are, and not as their owner has measured them.
struct TrueWheels {
  std::array<double, 2> radius_m{};  ///< left, right
  double separation_m = 0;           ///< effective

  [[nodiscard]] static TrueWheels draw(const WheelConfig& config, const drive::Config& measured, Random& random) {
    const auto [left, right] = random.normal_pair();
    TrueWheels wheels;
    wheels.radius_m = {measured.wheel_radius_m * (1 + config.radius_error * left),
                       measured.wheel_radius_m * (1 + config.radius_error * right)};
    wheels.separation_m = measured.wheel_separation_m * (1 + config.separation_error * random.normal_pair().first);
    return wheels;
  }
};

}  // namespace cairn::simulator
