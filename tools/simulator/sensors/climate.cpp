// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/climate.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/sensors/look.hpp"

namespace cairn::simulator {
namespace {

constexpr float kNight = 1.0F / 1500.0F;
const Rgb kMoonless(0.75F, 0.85F, 1.2F);

Rgb daylight(const Climate& climate, const Eigen::Vector3d& normal, bool sunlit) {
  const auto up = static_cast<float>(0.5 + 0.5 * normal.z());
  Rgb light = up * Rgb(0.22F, 0.27F, 0.36F) + (1 - up) * Rgb(0.12F, 0.11F, 0.10F);
  if (sunlit) light += static_cast<float>(std::max(0.0, normal.dot(climate.sun))) * Rgb(0.80F, 0.74F, 0.64F);
  return light;
}

/// Lamps all over the ceiling light floors most; walls differ by where they look, so that corners show.
Rgb lamplight(const Eigen::Vector3d& normal) {
  const auto up = static_cast<float>(0.5 + 0.5 * normal.z());
  const auto side = static_cast<float>(0.08 * normal.x() + 0.05 * normal.y());
  return (0.36F + 0.34F * up + side) * Rgb(1.0F, 0.95F, 0.86F);
}

}  // namespace

Climate Climate::of(const World& world, bool night) {
  Climate climate;
  climate.open_air = world.open_air;
  climate.night = night;
  climate.air_c = world.open_air ? (night ? 11.0 : 22.0) : (night ? 19.0 : 21.0);
  return climate;
}

Rgb Climate::light(const Eigen::Vector3d& normal, bool sunlit) const {
  const Rgb day = open_air ? daylight(*this, normal, sunlit) : lamplight(normal);
  return night ? Rgb(kNight * day.cwiseProduct(kMoonless)) : day;
}

Rgb Climate::sky(const Eigen::Vector3d& direction) const {
  const double up = std::clamp(direction.z(), 0.02, 1.0);
  const auto high = static_cast<float>(std::sqrt(up));
  Rgb colour = (1 - high) * Rgb(0.72F, 0.80F, 0.90F) + high * Rgb(0.22F, 0.40F, 0.75F);
  const Eigen::Vector3d cloud(direction.x() / up * 0.6, direction.y() / up * 0.6, 7.0);
  const auto cover =
      static_cast<float>(std::clamp(2.2 * (value_noise(cloud) + 0.5 * value_noise(2.3 * cloud)) - 1.75, 0.0, 1.0));
  colour += 0.7F * cover * (Rgb(0.95F, 0.95F, 0.95F) - colour);
  return night ? Rgb(kNight * 0.6F * colour.cwiseProduct(kMoonless)) : colour;
}

double Climate::sky_c(const Eigen::Vector3d& direction) const {
  if (!open_air) return air_c;
  return air_c - 6.0 - 26.0 * std::clamp(direction.z(), 0.0, 1.0);
}

}  // namespace cairn::simulator
