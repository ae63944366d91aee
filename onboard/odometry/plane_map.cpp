// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/plane_map.hpp"

#include <algorithm>

#include "onboard/odometry/voxel_key.hpp"

namespace cairn {
namespace {

// Rings of a 16-beam sensor are 0.035 rad apart: beyond this many edges too few of them cross a block.
constexpr float kRangeInEdges = 40.0F;

/// Coordinates in halves of the finest block; every grid's index follows from them by shifts.
BlockIndex halves(const Eigen::Vector3d& p, double per_metre) {
  return {floor_to_int(p.x() * per_metre), floor_to_int(p.y() * per_metre), floor_to_int(p.z() * per_metre)};
}

BlockIndex block_of(const BlockIndex& h, int level, int staggered) {
  return {((h.x >> level) + staggered) >> 1, ((h.y >> level) + staggered) >> 1, ((h.z >> level) + staggered) >> 1};
}

}  // namespace

PlaneMap::PlaneMap(const Config& config) : halves_per_metre_(2.0 / config.finest_block_m), criteria_(config.criteria) {
  for (int level = 0; level < kLevels; ++level)
    for (const bool staggered : {false, true})
      grids_.emplace_back(static_cast<float>(config.finest_block_m * (1 << level)), staggered,
                          PlaneGrid::Limits{static_cast<std::size_t>(config.max_blocks) >> (level > 0 ? 1 : 0),
                                            static_cast<float>(config.max_points_per_block)});
}

void PlaneMap::insert(std::span<const MapPoint> points, float epoch, Workers& workers) {
  workers.for_each(grids_.size(), [&](std::size_t g) {
    const int level = static_cast<int>(g / 2), staggered = static_cast<int>(g % 2);
    const bool coarsest = level == kLevels - 1;
    const float reach = kRangeInEdges * static_cast<float>(grids_[g].edge());
    for (const MapPoint& point : points)
      if (coarsest || point.range_m < reach)
        grids_[g].add(block_of(halves(point.p_odom, halves_per_metre_), level, staggered), point.p_odom, epoch);
    grids_[g].refit(criteria_);
  });
}

PlaneMatch PlaneMap::match(const Eigen::Vector3d& p_odom, float gate) const {
  const BlockIndex h = halves(p_odom, halves_per_metre_);
  const float good = 4.0F * criteria_.noise_floor_m * criteria_.noise_floor_m;
  PlaneMatch best;
  for (int level = kLevels - 1; level >= 0; --level) {
    for (const int staggered : {0, 1}) {
      const PlaneGrid& grid = grids_[static_cast<std::size_t>(2 * level + staggered)];
      const BlockIndex at = block_of(h, level, staggered);
      const Plane* plane = grid.find(at);
      if (plane == nullptr) continue;
      const Eigen::Vector3f d = (p_odom - grid.centre(at)).cast<float>() - plane->centroid;
      const float distance = plane->normal.dot(d);
      const float variance = plane->prediction_variance(d.squaredNorm());
      if (std::abs(distance) > gate) {
        if (best.kind == PlaneMatch::Kind::kNone) best.kind = PlaneMatch::Kind::kOff;
      } else if (best.kind != PlaneMatch::Kind::kOn || variance < best.variance) {
        best = {PlaneMatch::Kind::kOn, distance, variance, plane->tilt_variance(), plane->epoch, plane->normal};
      }
    }
    if (best.kind == PlaneMatch::Kind::kOn && best.variance < good) break;
  }
  return best;
}

void PlaneMap::keep_within(const Eigen::Vector3d& centre, double radius) {
  for (PlaneGrid& grid : grids_) {
    grid.keep_within(centre, radius);
    for (double r = radius; 10 * grid.size() > 9 * grid.capacity(); r *= 0.9) grid.keep_within(centre, r);
  }
}

void PlaneMap::clear() {
  for (PlaneGrid& grid : grids_) grid.clear();
}

std::size_t PlaneMap::planes() const {
  std::size_t n = 0;
  for (const PlaneGrid& grid : grids_) n += grid.planes();
  return n;
}

std::size_t PlaneMap::blocks() const {
  std::size_t n = 0;
  for (const PlaneGrid& grid : grids_) n += grid.size();
  return n;
}

}  // namespace cairn
