// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/workers.hpp"
#include "onboard/odometry/plane_grid.hpp"

namespace cairn {

/// A point to be remembered.
struct MapPoint {
  Eigen::Vector3d p_odom;
  float range_m;  ///< from the sensor; far points are too sparse for fine blocks
};

/// What the map knows about one point.
struct PlaneMatch {
  enum class Kind : std::uint8_t { kNone, kOff, kOn };
  Kind kind = Kind::kNone;                           ///< no plane here; planes, but all beyond the gate; on a plane
  float distance = 0;                                ///< signed, along `normal` [m]
  float variance = 0;                                ///< of the distance [m²]
  float tilt_variance = 0;                           ///< of the normal [rad²]
  float epoch = 0;                                   ///< mean epoch of the plane
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< in odom
};

/// The recent past as planes at several resolutions: pairs of staggered grids with blocks of e, 2e, 4e. A point is
/// matched with the coarsest block that really is a plane: large planes average the noise away, small ones follow the
/// detail.
class PlaneMap {
 public:
  struct Config {
    double finest_block_m;
    int max_blocks;  ///< in each finest grid; half as many in each coarser one
    int max_points_per_block;
    PlaneCriteria criteria;
  };
  explicit PlaneMap(const Config& config);

  /// Adds points, all of one epoch, and refits. Every grid is the work of one worker.
  void insert(std::span<const MapPoint> points, float epoch, Workers& workers);
  /// The best plane for p, not farther than `gate` metres from it.
  [[nodiscard]] PlaneMatch match(const Eigen::Vector3d& p_odom, float gate) const;
  /// Forgets what is farther than `radius`; when a grid is nearly full, also what is nearer, until a quarter is free.
  void keep_within(const Eigen::Vector3d& centre, double radius);
  void clear();

  [[nodiscard]] std::size_t planes() const;
  [[nodiscard]] std::size_t blocks() const;

 private:
  static constexpr int kLevels = 3;
  double halves_per_metre_;
  PlaneCriteria criteria_;
  std::vector<PlaneGrid> grids_;  // 2·level + (1 if staggered), level 0 the finest
};

}  // namespace cairn
