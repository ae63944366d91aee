// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "tools/simulator/people/figure.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::simulator {

/// A pinhole without distortion, in the sensor's REP-103 frame: x along the optical axis, y to the left, z up. Pixel
/// (u, v) has its centre at (u + 0.5, v + 0.5) from the upper left corner, as cx and cy count.
struct Lens {
  int width = 0, height = 0;              ///< pixels
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels
  /// Unit length, in the sensor's frame.
  [[nodiscard]] Eigen::Vector3d direction(int u, int v) const;
};

/// What one pixel sees.
struct Sighting {
  double distance = std::numeric_limits<double>::infinity();  ///< m along the ray; infinite: the sky
  Eigen::Vector3d direction{1, 0, 0};                         ///< of the ray, in the world
  Eigen::Vector3d point{0, 0, 0};                             ///< in the world
  Eigen::Vector3d pattern{0, 0, 0};  ///< where on the surface: the point, but fixed to a person who walks
  Eigen::Vector3d normal{0, 0, 0};   ///< towards the eye
  Material material{};
  int person = -1;                ///< of the crowd, or none
  double through = 1;             ///< share of light that comes through the clear glass before it; 1: none
  Eigen::Vector3d pane{0, 0, 0};  ///< normal of the nearest such glass, towards the eye

  [[nodiscard]] bool sky() const { return !(distance < 1e9); }
  [[nodiscard]] std::uint8_t class_id() const { return sky() ? kSkyClass : properties(material).class_id; }
};

/// The world at the instant of an exposure: what stands and who walks. Refers to both.
struct Instant {
  const Tracer& tracer;
  std::span<const Figure> people;

  /// Whether the way from `from` to the sun is free; `normal` lifts it off its own surface.
  [[nodiscard]] bool sunlit(const Eigen::Vector3d& from, const Eigen::Vector3d& normal,
                            const Eigen::Vector3d& sun) const;
};

inline constexpr double kSight = 300.0;  ///< m, farther than any world is wide

/// What clear glass is to a camera: a thermal one sees the glass, others see through it.
enum class ClearGlass : std::uint8_t { kOpaque, kClear };

/// One row of pixels, seen from T_world_camera. `out` has the lens's width.
void look(const Instant& instant, const Lens& lens, const SE3& T_world_camera, int row, std::span<Sighting> out,
          ClearGlass glass = ClearGlass::kOpaque);

}  // namespace cairn::simulator
