// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/result.hpp"
#include "tools/simulator/world/mesh.hpp"

namespace cairn::simulator {

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit length
};

struct Hit {
  double distance = 0;       ///< m
  double cos_incidence = 0;  ///< |cosine| of the angle between ray and surface normal
  Material material{};
};

/// What a camera's ray meets.
struct Surface {
  double distance = std::numeric_limits<double>::infinity();  ///< m; infinite: nothing, the sky
  Eigen::Vector3d normal{0, 0, 0};                            ///< unit length, towards the ray's origin
  Material material{};
};

/// Finds what a ray hits first. Embree finds the triangle; the distance is then computed in double precision from that
/// triangle, so no digit of it depends on the vector units of the machine. Safe to call from several threads at once.
class Tracer {
 public:
  /// Builds the acceleration structure; keeps its own copy of the triangles. Errc::kLimit when memory runs out.
  [[nodiscard]] static Result<Tracer> build(const Mesh& mesh);

  /// Distances in [min_distance, max_distance], metres; null when nothing is there.
  [[nodiscard]] std::optional<Hit> trace(const Ray& ray, double min_distance, double max_distance) const;

  /// The same for many rays from one point, four at a time: for pictures, where neighbours see much the same.
  /// `directions` have unit length; `out` is as long.
  void trace(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3d> directions, double max_distance,
             std::span<Surface> out) const;
  /// Whether anything lies between `from` and `max_distance` in `direction` (unit length).
  [[nodiscard]] bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double max_distance) const;

 private:
  struct Embree;
  struct Release {
    void operator()(Embree* embree) const;
  };
  Tracer(std::unique_ptr<Embree, Release> embree, std::vector<Triangle> triangles);

  std::unique_ptr<Embree, Release> embree_;
  std::vector<Triangle> triangles_;
};

}  // namespace cairn::simulator
