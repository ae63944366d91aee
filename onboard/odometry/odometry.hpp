// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/budget.hpp"
#include "hal/drive.hpp"
#include "hal/point_cloud.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/workers.hpp"
#include "onboard/odometry/config.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/odometry/estimation/motion_source.hpp"
#include "onboard/odometry/estimation/motion_update.hpp"
#include "onboard/odometry/estimation/twist_check.hpp"
#include "onboard/odometry/estimation/wheel_aid.hpp"
#include "onboard/odometry/estimation/wheel_bridge.hpp"
#include "onboard/odometry/keypoint_selector.hpp"
#include "onboard/odometry/local_map.hpp"
#include "onboard/odometry/motion_prior.hpp"
#include "onboard/odometry/recent_scans.hpp"
#include "onboard/odometry/registration.hpp"
#include "onboard/odometry/relocaliser.hpp"
#include "onboard/odometry/scan_deskewer.hpp"
#include "onboard/odometry/scan_preparation.hpp"
#include "onboard/odometry/second_look.hpp"
#include "onboard/odometry/start_search.hpp"
#include "onboard/odometry/straightened.hpp"
#include "onboard/odometry/tracking_state.hpp"

namespace cairn::odometry {

/// The robot's motion, as one scan shows it. Its stamp is scan.valid.end.
struct OdometryUpdate : MotionUpdate {
  /// The scan's finite points (all of them, as a rule) in the scan's order, deskewed, in base_link
  /// at `stamp`. Owned by the odometry and valid until the next update.
  std::span<const Eigen::Vector3f> points_base;

  bool converged = false;
  double inlier_ratio = 0;  ///< points within 3 σ of a plane / points whose neighbourhood holds planes
  double rms_m = 0;         ///< point-to-plane distance, robustly weighted
  /// The first `degenerate_directions` are valid: unit (translation, rotation·length) in base_link.
  std::array<Vector6, 6> degenerate{};
  double degenerate_length_m = 1;  ///< the lever arm at which rotations were compared with translations
};

/// Steps that one scan can take at most: a limit for its budget that cuts nothing short.
[[nodiscard]] int most_steps(const OdometryConfig& config);

/// LiDAR odometry: predict, deskew and register every scan against planes of the recent past.
///
/// An iterated Kalman filter over pose and twist; the twist deskews the scan inside the iteration,
/// so distorted points take part in estimating it. Same input, same bits, for any number of
/// workers.
class LidarOdometry final : public MotionSource {
 public:
  /// `T_base_lidar` takes a point of the sensor to base_link. `workers` must outlive the odometry.
  LidarOdometry(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers);

  /// Consumes one scan. Every iteration asks the budget; one is always made. `wheels`: their state at
  /// the scan's end, null where it is not known. It bridges gaps and times in which scans do not fit, and tells the
  /// motion along directions that scans leave open. Errors (the state is left as it was):
  ///   - kMalformed: the scan is not later than the last one, or has points without a firing time
  ///   - kLimit: too many points
  ///   - kTruncated: the scan is a piece of a revolution, and follows a gap or does not fit
  Result<OdometryUpdate> update(const Scan& scan, Budget& budget, const DriveState* wheels = nullptr);

  /// Goes on from where a previous run ended. To be called before the first scan. `scans` are the
  /// last ones it placed (finite points). At `stamp` the base was at `T_odom_base` and had this
  /// `twist` (m/s, rad/s). It has come to rest since, or nearly, some metres farther on. The first
  /// scan looks for it there. If that scan does not fit, the robot is somewhere else, and the scan
  /// begins a new trajectory: `began`.
  void resume(const UncertainPose& T_odom_base, const Vector6& twist, Time stamp, std::span<const PlacedScan> scans);

  /// The first scan after resume() is still to come. Grant it every iteration.
  [[nodiscard]] bool resuming() const { return relocaliser_.pending(); }

  [[nodiscard]] const MotionFilter& motion() const override { return filter_; }
  [[nodiscard]] MotionNoise expected_noise() const override { return prior_.usual(map_.settled()); }

  /// Blocks the map holds, for figures and tests.
  [[nodiscard]] std::size_t map_blocks() const { return map_.patches().blocks(); }

  static constexpr std::size_t kMaxPoints = ScanPreparation::kMaxPoints;

 private:
  /// Of a scan's keypoints. In offices after 10 s, fits of a new room's scan that had 0.11 to 0.18 of them near the map
  /// were up to 0.8 m off, or tilted; right ones had 0.48 and more.
  static constexpr double kKnownShare = 0.3;

  /// The scan that began the map, until the next one shows how the base moved.
  struct FirstScan {
    PreparedScan scan;
    std::vector<std::uint32_t> for_map;
  };

  OdometryUpdate begin(const PreparedScan& scan, const Selection& selected);
  [[nodiscard]] MotionState start_hypothesis(const Selection& selected, double dt_s);
  [[nodiscard]] Fit align(const Selection& selected, double dt_s, Budget& budget);
  [[nodiscard]] std::optional<Fit> look_farther(const Selection& selected, const Fit& first, double dt_s,
                                                const OpenMotion* open, Budget& budget);
  /// Whether wheels tell the motion better than the twist of the last scan that was followed.
  [[nodiscard]] bool bridged(double dt_s) const {
    const bool needed = dt_s > config_.second_look.long_step_s || tracking_.lost();
    return needed && !wheel_aid_.wrong_scale() && wheels_.since_followed().has_value();
  }
  /// After a long silence: no wheels tell the way since the last scan that was followed, or they exclude where `fit`
  /// is, or few of the scan's keypoints are near the map.
  [[nodiscard]] bool unguided(const Fit& fit, std::size_t keypoints, double dt_s) const {
    const bool known = fit.equations.matched >= kKnownShare * static_cast<double>(keypoints);
    const bool guided = known && bridged(dt_s) && wheels_.allow(filter_.motion_to(fit.state.T_odom_base));
    return tracking_.blind() && !guided;
  }
  /// To the scan that comes now: by wheels where they tell more than the twist, otherwise steadily.
  void predict(double dt_s, const OpenMotion* open) {
    filter_ = bridged(dt_s) ? wheels_.move(followed_, dt_s) : followed_;
    if (!bridged(dt_s)) filter_.predict(dt_s, prior_.usual(map_.settled()), open);
  }
  [[nodiscard]] bool misled(const Fit& piece) const {
    return !tracking_.fits(piece) || second_look_.misled(piece, filter_, map_.settled());
  }
  [[nodiscard]] bool follow(const Fit& fit, const SE3& motion, double dt_s);
  [[nodiscard]] bool lose(Track track, const Fit& fit, double dt_s);
  void correct(const Fit& fit, double dt_s);
  void learn(const Fit& fit, double dt_s);
  void reinitialise();
  /// Makes the map again of its first scan alone, deskewed with `twist`.
  void begin_again(const FirstScan& first, const Vector6& twist);
  void keep_first(const PreparedScan& scan, const Selection& selected);
  [[nodiscard]] Fit straighten_first(const Selection& selected, const Fit& fit, double dt_s, Budget& budget);
  void insert(std::span<const std::uint32_t> chosen, const MotionFilter& at, Time stamp);
  [[nodiscard]] OdometryUpdate report(Time stamp) const;
  [[nodiscard]] OdometryUpdate report(Time stamp, const Fit& fit, Track track) const;
  [[nodiscard]] double known_share(const PlacedScan& scan);

  OdometryConfig config_;
  SE3 T_base_lidar_;
  ScanPreparation preparation_;
  KeypointSelector selector_;
  ScanDeskewer deskewer_;
  MotionFilter filter_;    // at the last scan: corrected by it, or predicted if it was lost
  MotionFilter followed_;  // at the last scan that was followed
  SE3 T_odom_previous_;    // of the scan before the last
  MotionPrior prior_;
  LocalMap map_;
  StartSearch start_search_;
  Registration registration_;
  SecondLook second_look_;
  TrackingState tracking_;
  TwistCheck twist_check_;
  WheelBridge wheels_;
  WheelAid wheel_aid_;
  Relocaliser relocaliser_;
  std::optional<FirstScan> first_;
  bool by_wheels_ = false;  // see MotionUpdate
  /// A guess of how the map before lies in this one, which must not be added to it; none: this one goes on.
  std::optional<UncertainPose> T_odom_before_;
};

}  // namespace cairn::odometry
