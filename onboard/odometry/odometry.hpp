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
#include "onboard/odometry/drift_history.hpp"
#include "onboard/odometry/estimation/degeneracy.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/odometry/estimation/normal_equations.hpp"
#include "onboard/odometry/local_map/patch_map.hpp"
#include "onboard/odometry/local_map/subsample.hpp"
#include "onboard/odometry/recent_scans.hpp"

namespace cairn {

/// What one scan told about the robot's motion.
struct OdometryUpdate {
  Time stamp{};                     ///< = scan.valid.end; all poses are of this instant
  UncertainPose T_odom_base;        ///< since the start, where T_odom_base was the identity
  UncertainPose T_previous_base;    ///< since the scan before
  Vector6 twist = Vector6::Zero();  ///< of base_link in base_link: m/s, rad/s
  /// The scan's finite points (all of them, as a rule) in the scan's order, deskewed, in base_link at `stamp`. Owned by
  /// the odometry and valid until the next update.
  std::span<const Eigen::Vector3f> points_base;

  int iterations = 0;
  bool converged = false;
  double inlier_ratio = 0;  ///< points within 3 σ of a plane / points whose neighbourhood holds planes
  double rms_m = 0;         ///< point-to-plane distance, robustly weighted
  /// Directions the surroundings do not determine; along them the pose is the prediction and the covariance grows.
  int degenerate_directions = 0;
  /// The first `degenerate_directions` are valid: unit (translation, rotation·length) in base_link.
  std::array<Vector6, 6> degenerate{};
  double degenerate_length_m = 1;  ///< the lever arm at which rotations were compared with translations

  bool began = false;          ///< the first scan: T_odom_base is the identity, odom has nothing in common with before
  bool lost = false;           ///< the scan did not fit: the pose is predicted, the map was left alone
  bool reinitialised = false;  ///< lost for too long: this scan began a new map at the predicted pose
};

/// LiDAR odometry: predict, deskew and register every scan against planes of the recent past.
///
/// An iterated Kalman filter over pose and twist; the twist deskews the scan inside the iteration, so distorted points
/// take part in estimating it. Same input, same bits, for any number of workers.
class LidarOdometry {
 public:
  /// `T_base_lidar` takes a point of the sensor to base_link. `workers` must outlive the odometry.
  LidarOdometry(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers);

  /// Consumes one scan. Every iteration asks the budget; one is always made. Errors (the state is left as it was):
  /// kMalformed for a scan that is not later than the last one or whose arrays differ in length, kLimit for too many
  /// points.
  Result<OdometryUpdate> update(const Scan& scan, Budget& budget);

  /// Goes on from where a run ended: `scans` are the last ones it placed (finite points), `T_odom_base` where the base
  /// was at `stamp`, and how fast (`twist`). It has come to rest since, or nearly, some metres farther on; the first
  /// scan looks for it there. If that scan does not fit, the robot is somewhere else, and the scan begins anew:
  /// `began`. To be called before the first scan.
  void resume(const UncertainPose& T_odom_base, const Vector6& twist, Time stamp, std::span<const PlacedScan> scans);

  /// The first scan after resume() is still to come: it is worth every iteration.
  [[nodiscard]] bool resuming() const { return resumed_.has_value(); }

  /// Blocks the map holds, for figures and tests.
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

  Result<void> check(const Scan& scan) const;
  void take(const Scan& scan);
  void choose_keypoints();
  /// The prediction; while the speed is unknown, the forward speed that puts most points onto planes.
  /// Where registration begins: the prediction, or what fits better where the prediction says little.
  MotionState first_guess(double dt);
  MotionState guess_speed(double dt);
  /// Keypoints that would lie within `gate` [m] of their planes.
  [[nodiscard]] double inliers(const MotionState& at, double gate);
  Fit fit(const MotionState& guess, Budget& budget);
  [[nodiscard]] bool plausible(const Fit& fit, double dt) const;
  [[nodiscard]] double known_share(const PlacedScan& scan);
  [[nodiscard]] bool found_again(const Fit& fit) const;
  void accept(const Fit& fit);
  OdometryUpdate start(Time stamp);
  void lose_track(OdometryUpdate& update);
  void begin_map();
  void insert();
  void insert_points(const SE3& T_odom_base);
  void deskew_all(const Vector6& twist);
  [[nodiscard]] Matrix6 odom_covariance() const;
  void fill(OdometryUpdate& update) const;

  OdometryConfig config_;
  SE3 T_base_lidar_;
  Workers& workers_;

  PatchMap map_;
  MotionFilter filter_;
  DriftHistory drift_;
  Linearise linearise_;
  Subsample dense_, sparse_;
  float keypoint_spacing_m_;

  std::optional<Time> last_stamp_;
  struct Resumed {
    SE3 T_odom_base;         // when the run ended
    double farthest_m;       // that the base may have come since
    double known_share = 0;  // of a saved scan's keypoints those on known surfaces
  };
  std::optional<Resumed> resumed_;  // as long as the first scan after resume() is still to come
  SE3 T_odom_previous_;
  int lost_in_a_row_ = 0;
  int scans_in_map_ = 0;
  // In a corridor the speed stays unknown for ever; what the first scans cannot tell, later ones cannot either.
  static constexpr int kGuesses = 3;
  int guesses_left_ = 0;
  SE3 T_odom_pruned_;

  // The scan at hand.
  std::vector<Eigen::Vector3f> points_lidar_;
  std::vector<float> age_s_;
  double duration_s_ = 0;
  double revolution_s_ = 0;  // the longest of the last scans; zero for scans without firing times
  std::vector<std::uint32_t> in_range_;
  std::span<const std::uint32_t> dense_points_;
  std::vector<Keypoint> keypoints_;
  std::vector<Eigen::Vector3f> points_base_;
  std::vector<Eigen::Vector3d> map_points_;
};

}  // namespace cairn
