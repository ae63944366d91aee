// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "tools/simulator/world/mesh.hpp"
#include "tools/simulator/world/tracer.hpp"

namespace cairn::simulator {

/// All points within `radius` of the segment a–b. Metres.
struct Capsule {
  Eigen::Vector3d a{0, 0, 0}, b{0, 0, 0};
  double radius = 0;
  Material material{};
};

struct CapsuleHit {
  double distance = 0;              ///< m
  Eigen::Vector3d normal{0, 0, 0};  ///< unit length, outwards
};

/// Where a ray from outside first meets the capsule: the quadratic of an infinite cylinder between its ends, that of a
/// sphere beyond them (Ericson, "Real-Time Collision Detection", 5.3.7). `ray.direction` has unit length.
[[nodiscard]] std::optional<CapsuleHit> intersect(const Ray& ray, const Capsule& capsule);

/// What a person looks like.
struct Build {
  double height = 1.75;  ///< m
  Material top = Material::kClothesBlue, trousers = Material::kClothesDark;
  bool long_sleeves = true;
};

/// A person at an instant: capsules in the world, and a ball around them all.
struct Figure {
  static constexpr std::size_t kParts = 18;
  int person = 0;
  Placement stand;  ///< on the ground, x forward
  Eigen::Vector3d centre{0, 0, 0};
  double reach = 0;
  std::array<Capsule, kParts> parts;
};

struct FigureHit {
  double distance = 0;
  Eigen::Vector3d normal{0, 0, 0};
  const Figure* figure = nullptr;
  const Capsule* part = nullptr;
};

/// How far a step reaches, m, for a person of `height` at `speed` m/s (Grieve and Gear, 1966, linearised).
[[nodiscard]] double step_length(double height, double speed);

/// Poses a walking person: legs swing about the hip with bent knees, arms against them; the lower foot touches the
/// ground. `phase` in radians: 2π is two steps. At speed 0 the person stands.
[[nodiscard]] Figure pose(const Build& build, const Placement& stand, double phase, double speed);

/// Whether the ray passes within `reach` of `centre` and not only behind its origin.
[[nodiscard]] bool may_hit(const Ray& ray, const Eigen::Vector3d& centre, double reach);

/// The nearest of all parts of all figures within `max_distance`.
[[nodiscard]] std::optional<FigureHit> trace(std::span<const Figure> figures, const Ray& ray, double max_distance);

}  // namespace cairn::simulator
