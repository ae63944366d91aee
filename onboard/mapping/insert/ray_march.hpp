// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "onboard/mapping/insert/footprint.hpp"

namespace cairn::mapping {

/// A ray ready to march from the voxel of the sensor: what OctoMap's computeRayKeys() has computed when its loop
/// starts.
struct Ray {
  std::array<double, 3> t_max;        ///< distance along the ray to the next voxel border, per axis
  std::array<double, 3> t_delta;      ///< distance between two borders
  double length;                      ///< of the ray, in metres, rounded to float as OctoMap does
  std::uint64_t end;                  ///< index of the end voxel, which is not marked
  std::array<std::uint64_t, 3> step;  ///< see BrickGrid::axis_step()
};

/// Marks the voxels of each ray as free, up to the end voxel, which is left out: exactly those of OctoMap's
/// computeRayKeys() (J. Amanatides, A. Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987), the same
/// roundings and ties included. `origin` is the index of the voxel they all start from; it is the
/// caller's to mark, and may or may not be marked here.
using MarchRays = void (*)(std::span<const Ray> rays, std::uint64_t origin, Footprint& footprint);

/// The reference, for any machine and any footprint.
void march_rays_scalar(std::span<const Ray> rays, std::uint64_t origin, Footprint& footprint);

/// For flat footprints, on machines with AVX2; null elsewhere.
[[nodiscard]] MarchRays march_rays_avx2();

/// The fastest one for this machine and footprint.
[[nodiscard]] MarchRays best_march(const Footprint& footprint);

}  // namespace cairn::mapping
