// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/ground_below.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace cairn::people {
namespace {

/// Levels below a sensor, of which one is the ground's.
constexpr std::size_t kLevels = 150;
constexpr float kLevelThickness = 0.2F, kLowestLevel = 30;  // m
constexpr float kInPlan = 8;                                // m in plan
// Points of the ground, at least. Chosen by hand: of a stereo camera's points, some 3 % are wrong.
constexpr std::size_t kFewestOfGround = 60;
constexpr float kShareOfGround = 0.06F;

}  // namespace

std::optional<float> height_above_ground(std::span<const Eigen::Vector3f> points_odom,
                                         const Eigen::Vector3f& sensor_odom) {
  std::array<std::size_t, kLevels> count{};
  std::array<float, kLevels> sum{};
  std::size_t all = 0;
  for (const Eigen::Vector3f& p : points_odom) {
    const float below = sensor_odom.z() - p.z();
    if (!((p - sensor_odom).head<2>().norm() < kInPlan) || !(below > 0 && below < kLowestLevel)) continue;
    const auto level = std::min(kLevels - 1, static_cast<std::size_t>(below / kLevelThickness));
    ++count[level], ++all;
    sum[level] += below;
  }
  const std::size_t enough =
      std::max(kFewestOfGround, static_cast<std::size_t>(kShareOfGround * static_cast<float>(all)));
  for (std::size_t level = kLevels; level-- > 0;) {
    // The floor may lie on both sides of a border between two levels.
    const std::size_t above = level > 0 ? count[level - 1] : 0;
    if (count[level] + above < enough) continue;
    return (sum[level] + (level > 0 ? sum[level - 1] : 0)) / static_cast<float>(count[level] + above);
  }
  return std::nullopt;
}

}  // namespace cairn::people
