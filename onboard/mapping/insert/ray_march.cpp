// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/ray_march.hpp"

#include <algorithm>
#include <bit>

namespace cairn::mapping {
namespace {

std::uint64_t all_ones_if(bool condition) { return std::uint64_t{0} - static_cast<std::uint64_t>(condition); }

double only_if(std::uint64_t mask, double value) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) & mask);
}

// Branch-free, because which axis comes next cannot be predicted: the one with the nearest border, and among equals z
// before y before x, as in OctoMap.
template <bool kFlat>
void march(const Ray& ray, std::uint64_t origin, Footprint& footprint) {
  const BrickGrid& grid = footprint.grid();
  const std::uint64_t mask_x = grid.axis_mask(0), mask_y = grid.axis_mask(1), mask_z = grid.axis_mask(2);
  std::uint64_t x = origin & mask_x, y = origin & mask_y, z = origin & mask_z;
  double tx = ray.t_max[0], ty = ray.t_max[1], tz = ray.t_max[2];
  for (;;) {
    const std::uint64_t z_next = all_ones_if(tz <= std::min(tx, ty));
    const std::uint64_t y_next = all_ones_if(ty <= tx) & ~z_next;
    const std::uint64_t x_next = ~(z_next | y_next);
    tx += only_if(x_next, ray.t_delta[0]);
    ty += only_if(y_next, ray.t_delta[1]);
    tz += only_if(z_next, ray.t_delta[2]);
    x = (x - (ray.step[0] & x_next)) & mask_x;
    y = (y - (ray.step[1] & y_next)) & mask_y;
    z = (z - (ray.step[2] & z_next)) & mask_z;
    const std::uint64_t index = x | y | z;
    // Rounding can make a ray miss its end voxel; OctoMap then stops at the length.
    if (index == ray.end || std::min(std::min(tx, ty), tz) > ray.length) return;
    footprint.mark_free<kFlat>(index);
  }
}

}  // namespace

void march_rays_scalar(std::span<const Ray> rays, std::uint64_t origin, Footprint& footprint) {
  for (const Ray& ray : rays)
    footprint.flat() ? march<true>(ray, origin, footprint) : march<false>(ray, origin, footprint);
}

MarchRays best_march(const Footprint& footprint) {
  const MarchRays simd = march_rays_avx2();
  return simd != nullptr && footprint.flat() ? simd : march_rays_scalar;
}

}  // namespace cairn::mapping
