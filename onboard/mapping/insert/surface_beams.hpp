// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "onboard/mapping/insert/brick_grid.hpp"
#include "onboard/mapping/insert/ray_march.hpp"
#include "onboard/mapping/tree/voxel_finder.hpp"

namespace cairn::mapping {

/// Where a ray ends.
struct BeamEnd {
  VoxelKey voxel;            ///< the ray ends in its middle
  std::array<int, 3> steps;  ///< of the ray: −1, 0 or 1 along each axis
};

/// Finds how far a beam frees voxels before it runs along the surface that it ends on.
///
/// A beam that meets a floor at 1° goes through the floor's own voxels for the last metres: a plane fills no voxel, and
/// at 0.1 m the beam stays in their layer for 5.7 m. In OctoMap these passes are misses. There are many more of them
/// than hits, because each ring of a LiDAR meets a place once or twice and then passes it in every scan. So far floors,
/// ceilings and walls beside the robot vanish although they were seen.
///
/// Here the beam is followed back from its end, through what is occupied. Gaps of up to kLongestGap voxels are passed
/// over. If kFewest voxels or more are occupied, nothing from the first of them to the end is freed. One occupied voxel
/// is no surface that is run along: what is left of noise in front of a wall is freed as ever. So is what has gone from
/// a place that is more than the gap away from where the beam ends. What moves away along the beam leaves a trail of at
/// most kLongest voxels before it, until it has gone.
class SurfaceBeams {
 public:
  static constexpr int kFewest = 2;      ///< occupied voxels in a row; see docs/maps.md for how both were chosen
  static constexpr int kLongestGap = 2;  ///< voxels: a surface between two layers fills both in part
  static constexpr int kLongest = 32;    ///< voxels: bounds the time. Most beams need three.

  explicit SurfaceBeams(const SemanticOcTree& tree) : voxels_(tree) {}

  /// Shortens rays to what they free. `ends[i]` belongs to `rays[i]`.
  void shorten(std::span<Ray> rays, std::span<const BeamEnd> ends);

  /// The length up to which the ray frees voxels, m; at most its own.
  [[nodiscard]] double free_length(const Ray& ray, const BeamEnd& end);

 private:
  VoxelFinder voxels_;
};

}  // namespace cairn::mapping
