// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/workers.hpp"
#include "onboard/odometry/local_map/patch_grid.hpp"

namespace cairn::odometry {

/// What the map knows about one point.
struct PatchMatch {
  enum class Kind : std::uint8_t { kNone, kOff, kOn };
  /// The distance of the point to the patch in one direction.
  struct Row {
    Eigen::Vector3f direction = Eigen::Vector3f::Zero();  ///< in odom
    float distance = 0;                                   ///< signed, along `direction` [m]
    float variance = 0;                                   ///< of the distance [m²]
  };
  Kind kind = Kind::kNone;  ///< no patch here; patches, but all beyond the gate; on a patch
  int rows = 0;             ///< directions that the patch fixes: 1 for a plane, 2 for a pole
  std::array<Row, 2> row{};
  float epoch = 0;      ///< mean epoch of the patch
  bool lasting = true;  ///< the patch has been seen for Config::lasting_s, or the map is hardly older
};

/// The recent past as patches at several resolutions: pairs of staggered grids with blocks of e, 2e, 4e. A point is
/// matched with the coarsest block that really is a plane: large planes average the noise away, small ones follow the
/// detail. Where nothing is flat, slim upright things hold the scan.
class PatchMap {
 public:
  /// Sizes and bounds of the grids.
  struct Config {
    double finest_block_m;
    int max_blocks;  ///< in each finest grid; half as many in each coarser one
    int max_points_per_block;
    PatchCriteria criteria;
    float lasting_s = 0;  ///< see PatchMatch::lasting
  };
  explicit PatchMap(const Config& config);

  /// Adds points (in odom), all of one epoch, and refits. Every grid is the work of one worker.
  void insert(std::span<const Eigen::Vector3d> points, const PatchGrid::Sensor& sensor, float epoch, Workers& workers);
  /// The best patch for p, seen from a sensor in direction `to_sensor`, not farther than `gate` metres from it.
  [[nodiscard]] PatchMatch match(const Eigen::Vector3d& p, const Eigen::Vector3f& to_sensor, float gate) const;
  /// Forgets what is farther than `radius`; when a grid is nearly full, also what is nearer, until a tenth is free.
  void keep_within(const Eigen::Vector3d& centre, double radius);
  void clear();

  /// The grid with the smallest blocks that is not staggered.
  [[nodiscard]] const PatchGrid& finest() const { return grids_.front(); }
  [[nodiscard]] std::size_t patches() const;
  [[nodiscard]] std::size_t blocks() const;

 private:
  static constexpr int kLevels = 3;
  double halves_per_metre_;
  float lasting_s_;
  PatchCriteria criteria_;
  std::vector<PatchGrid> grids_;  // 2·level + (1 if staggered), level 0 the finest
  float now_s_ = 0;               // of the last insert()
};

}  // namespace cairn::odometry
