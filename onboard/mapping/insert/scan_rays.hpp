// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/octomap_types.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.hpp"
#include "onboard/mapping/insert/footprint.hpp"
#include "onboard/mapping/insert/ray_march.hpp"
#include "onboard/mapping/insert/surface_beams.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"

namespace cairn::mapping {

/// Turns a scan into hits and rays, exactly as OctoMap's computeDiscreteUpdate() does: points
/// become the centres of their voxels, each voxel counts once, and beams longer than the maximal
/// range become free space up to it.
class ScanRays {
 public:
  /// `max_range` in metres; negative: no limit.
  ScanRays(double resolution, double max_range)
      : resolution_(resolution), resolution_factor_(1. / resolution), max_range_(max_range) {}

  /// From the next prepare() on; metres, negative: no limit.
  void set_max_range(double max_range_m) { max_range_ = max_range_m; }

  /// Points of a scan that were left out, by cause.
  struct Counts {
    std::size_t not_finite = 0, outside_map = 0;
  };

  /// Resets `footprint` to the box of the scan, marks the hits as occupied, and keeps the rays for
  /// march(). Errors: the origin is outside of the map; the rays are too long for the time a scan
  /// may take.
  Result<Counts> prepare(std::span<const Eigen::Vector3f> points_map, const Eigen::Vector3f& origin_map,
                         Footprint& footprint);

  [[nodiscard]] std::size_t ray_count() const { return targets_.size(); }

  /// Marks the free voxels of rays first to last − 1. Several threads may call it, each with a
  /// footprint of its own over the same grid. `surfaces`: the map, whose surfaces are spared by beams
  /// that run along them, see SurfaceBeams; null: OctoMap's voxels.
  void march(std::size_t first, std::size_t last, MarchRays march_rays, Footprint& footprint,
             const SemanticOcTree* surfaces) const;

  /// Voxels along all rays of one scan: bounds its time. 130 000 beams of 30 m at 0.1 m make 39
  /// million.
  static constexpr std::uint64_t kMaxSteps = 200'000'000;

 private:
  struct Target {
    octomap::point3d end;
    VoxelKey key;
  };

  [[nodiscard]] bool key_of(double coordinate, int& key) const;
  [[nodiscard]] bool key_of(const octomap::point3d& point, VoxelKey& key) const;
  [[nodiscard]] float centre_of(int key) const { return static_cast<float>(exact_centre_of(key)); }
  [[nodiscard]] double exact_centre_of(int key) const { return (static_cast<double>(key - 32768) + 0.5) * resolution_; }
  void add_point(const VoxelKey& key);
  [[nodiscard]] std::uint64_t steps_of_rays() const;
  [[nodiscard]] BrickGrid grid() const;
  [[nodiscard]] Ray ray_to(const Target& target, const BrickGrid& grid) const;
  [[nodiscard]] BeamEnd end_of(const Target& target) const;

  double resolution_, resolution_factor_, max_range_;
  octomap::point3d origin_;
  VoxelKey origin_key_{};
  std::vector<Target> hits_;
  std::vector<Target> targets_;  // of the rays to march
};

}  // namespace cairn::mapping
