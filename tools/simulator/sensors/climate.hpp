// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// Linear red, green, blue; 1 is what a white surface in full sun sends.
using Rgb = Eigen::Vector3f;

/// Light and warmth of one run.
struct Climate {
  bool open_air = false, night = false;
  Eigen::Vector3d sun =
      Eigen::Vector3d(0.42, -0.55, 0.72).normalized();  ///< towards it; in the south, where façades are lit
  double air_c = 21.0;                                  ///< °C

  /// Outdoors 22 °C by day and 11 °C by night; indoors 21 and 19.
  [[nodiscard]] static Climate of(const World& world, bool night);

  /// Whether a surface with this normal may be in the sun; whether it is, its surroundings decide.
  [[nodiscard]] bool may_be_sunlit(const Eigen::Vector3d& normal) const {
    return open_air && !night && normal.dot(sun) > 0;
  }
  /// Light on a surface: the sun where `sunlit`, the sky, and what the ground throws back; indoors lamps at the
  /// ceiling. By night all lamps are off: 1/1500 of the day is left.
  [[nodiscard]] Rgb light(const Eigen::Vector3d& normal, bool sunlit) const;
  /// What one sees where nothing is: clouds by day.
  [[nodiscard]] Rgb sky(const Eigen::Vector3d& direction) const;
  /// Apparent temperature of what nothing hides, °C: a clear sky is the colder the higher one looks; indoors the room.
  [[nodiscard]] double sky_c(const Eigen::Vector3d& direction) const;
};

}  // namespace cairn::simulator
