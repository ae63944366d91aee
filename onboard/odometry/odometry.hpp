// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/budget.hpp"
#include "hal/point_cloud.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/workers.hpp"
#include "onboard/odometry/config.hpp"
#include "onboard/odometry/degeneracy.hpp"
#include "onboard/odometry/drift_history.hpp"
#include "onboard/odometry/motion_filter.hpp"
#include "onboard/odometry/normal_equations.hpp"
#include "onboard/odometry/patch_map.hpp"
#include "onboard/odometry/scan_points.hpp"

namespace cairn {

/// What one scan told about the robot's motion.
struct OdometryUpdate {
  Time stamp{};                   ///< = scan.valid.end; all poses are of this instant
  UncertainPose T_odom_base;      ///< since the start, where T_odom_base was the identity
  UncertainPose T_previous_base;  ///< since the scan before
  /// The scan's finite points (all of them, as a rule) in the scan's order, deskewed, in base_link at `stamp`. Owned by
  /// the odometry and valid until the next update.
  std::span<const Eigen::Vector3f> points_base;

  int iterations = 0;
  bool converged = false;
  double inlier_ratio = 0;  ///< points within 3 σ of a patch / points whose neighbourhood holds patches
  double rms_m = 0;         ///< distance of the points to their patches, robustly weighted
  /// Directions the surroundings do not determine; along them the pose is the prediction and the covariance grows.
  int degenerate_directions = 0;
  /// The first `degenerate_directions` are valid: unit (translation, rotation·length) in base_link.
  std::array<Vector6, 6> degenerate{};
  double degenerate_length_m = 1;  ///< the lever arm at which rotations were compared with translations

  bool lost = false;           ///< the scan did not fit: the pose is predicted, the map was left alone
  bool reinitialised = false;  ///< lost for too long: this scan began a new map at the predicted pose
};

/// LiDAR odometry: predict, deskew and register every scan against patches of the recent past.
///
/// An iterated Kalman filter over pose and twist; the twist deskews the scan inside the iteration, so the distortion
/// takes part in estimating it. Same input, same bits, for any number of workers. Memory is bounded by the
/// configuration and the largest scan; once that was seen, nothing is allocated.
class LidarOdometry {
 public:
  /// `T_base_lidar` takes a point of the sensor to base_link. `workers` must outlive the odometry.
  LidarOdometry(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers);

  /// Consumes one scan. Every iteration asks the budget; one is always made. Errors (the state is left as it was):
  /// kMalformed for a scan that is not later than the last one or whose arrays differ in length, kLimit for too many
  /// points.
  Result<OdometryUpdate> update(const Scan& scan, Budget& budget);

  /// Blocks in the map, for figures and tests.
  [[nodiscard]] std::size_t map_blocks() const { return map_.blocks(); }

  static constexpr std::size_t kMaxPoints = 400'000;

 private:
  struct Fit {
    MotionState state;
    NormalEquations equations;
    Degeneracy degeneracy;
    int iterations = 0;
    bool converged = false;
  };

  [[nodiscard]] Result<void> check(const Scan& scan) const;
  void start();
  void track(double dt, Budget& budget, OdometryUpdate& update);
  void predict(double dt);
  Fit fit(Budget& budget);
  [[nodiscard]] bool plausible(const Fit& found, double dt) const;
  void accept(const Fit& found);
  void lose_track(OdometryUpdate& update);
  void forget_twist();
  void begin_map();
  void insert();
  bool is_news(const SE3& T_odom_base);
  [[nodiscard]] Matrix6 odom_covariance() const;

  OdometryConfig config_;
  SE3 T_base_lidar_;
  Workers& workers_;

  ScanPoints points_;
  PatchMap map_;
  MotionFilter filter_;
  DriftHistory drift_;
  Linearise linearise_;

  std::optional<Time> last_stamp_;
  SE3 T_odom_previous_;
  int lost_in_a_row_ = 0;

  SE3 T_odom_pruned_;  // where the map was last cut to its window
  SE3 T_odom_stance_;  // where the present stance began
  std::uint64_t stance_ = 0;
  int scans_at_stance_ = 0;
  std::vector<MapPoint> map_points_;
};

}  // namespace cairn
