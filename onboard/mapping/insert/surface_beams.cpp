// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/surface_beams.hpp"

#include <algorithm>
#include <cstddef>

namespace cairn::mapping {

namespace {

// Rays. Memory takes as long as some rays do. Chosen by hand.
constexpr std::size_t kParentsLead = 16, kVoxelsLead = 8;

/// About the first voxel that free_length() looks at: the one before the end, diagonally.
VoxelKey before(const BeamEnd& end) {
  return {end.voxel[0] - end.steps[0], end.voxel[1] - end.steps[1], end.voxel[2] - end.steps[2]};
}

}  // namespace

void SurfaceBeams::shorten(std::span<Ray> rays, std::span<const BeamEnd> ends) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (i + kParentsLead < rays.size()) voxels_.fetch_parents(before(ends[i + kParentsLead]));
    if (i + kVoxelsLead < rays.size()) voxels_.fetch_voxels(before(ends[i + kVoxelsLead]));
    rays[i].length = free_length(rays[i], ends[i]);
  }
}

double SurfaceBeams::free_length(const Ray& ray, const BeamEnd& end) {
  std::array<double, 3> border;  // m back from the end, where the next voxel along each axis begins
  for (std::size_t a = 0; a < 3; ++a) border[a] = end.steps[a] == 0 ? ray.t_delta[a] : ray.t_delta[a] / 2;
  VoxelKey at = end.voxel;
  double spared = 0;
  int occupied = 0, gap = 0;
  for (int i = 0; i < kLongest && gap <= kLongestGap; ++i) {
    const std::size_t a = border[2] <= std::min(border[0], border[1]) ? 2 : border[1] <= border[0] ? 1 : 0;
    const double near = border[a];
    at[a] -= end.steps[a];
    border[a] += ray.t_delta[a];
    const double far = *std::ranges::min_element(border);
    if (far >= ray.length) break;
    if (!voxels_.occupied(at)) {
      ++gap;
      continue;
    }
    ++occupied;
    gap = 0;
    spared = (near + far) / 2;  // its middle: rounding must not free the voxel, nor keep the one before it
  }
  return occupied < kFewest ? ray.length : ray.length - spared;
}

}  // namespace cairn::mapping
