// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hal/budget.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "onboard/odometry/estimation/drift_history.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/odometry/estimation/motion_source.hpp"
#include "onboard/odometry/estimation/motion_update.hpp"
#include "onboard/odometry/motion_prior.hpp"
#include "onboard/perception/stereo/stereo_pair.hpp"
#include "onboard/visual_odometry/bundle_adjuster.hpp"
#include "onboard/visual_odometry/config.hpp"
#include "onboard/visual_odometry/feature_tracker.hpp"
#include "onboard/visual_odometry/landmark_map.hpp"
#include "onboard/visual_odometry/place_memory.hpp"
#include "onboard/visual_odometry/pose_solver.hpp"

namespace cairn::visual_odometry {

/// The robot's motion, as one picture of both eyes shows it.
struct VisualUpdate : odometry::MotionUpdate {
  int followed = 0;   ///< landmarks that were followed into this picture
  int inliers = 0;    ///< of these, those that fit
  double rms_px = 0;  ///< of the inliers, in the left eye
  bool keyframe = false;
};

/// Steps that one picture can take at most: a limit for its budget that cuts nothing short.
[[nodiscard]] int most_steps(const VisualOdometryConfig& config);

/// Stereo visual odometry: follows corners, and finds the pose from which they are where the picture shows them.
///
/// Pose and twist are those of the same iterated Kalman filter as LidarOdometry's. Landmarks come of both eyes at a
/// keyframe, with the uncertainty of their depth. Every keyframe adjusts the last keyframes and their landmarks
/// together. A robot that has lost its way is looked for among the last keyframes. Same input, same bits, for any
/// number of threads.
class StereoOdometry final : public odometry::MotionSource {
 public:
  /// `T_base_eye`: optical frame of the left eye.
  StereoOdometry(const VisualOdometryConfig& config, const stereo::StereoGeometry& geometry, const SE3& T_base_eye);

  /// Consumes one pair. Every iteration asks the budget; one is always made. Error kMalformed (the state is left as it
  /// was): the pair is not later than the last one.
  Result<VisualUpdate> update(const stereo::StereoPair& pair, Budget& budget);

  /// To be called before the first pair: goes on where another one ended. `keyframes` are its last ones. Until a
  /// picture shows one of them, the robot is lost; after VisualOdometryConfig::give_up_after_s of pictures it begins
  /// anew.
  void resume(const UncertainPose& T_odom_base, const Vector6& twist, Time stamp, std::span<const Keyframe> keyframes);
  /// No picture has yet told whether the robot is where the other one ended.
  [[nodiscard]] bool resuming() const { return resuming_; }
  /// The keyframe that the last pair became; null: it became none.
  [[nodiscard]] const Keyframe* new_keyframe() const {
    return places_.newest() != nullptr && places_.newest()->stamp == last_ ? places_.newest() : nullptr;
  }

  [[nodiscard]] const odometry::MotionFilter& motion() const override { return filter_; }
  [[nodiscard]] odometry::MotionNoise expected_noise() const override { return prior_.usual(true); }

 private:
  [[nodiscard]] VisualUpdate begin(const stereo::StereoPair& pair, Budget& budget);
  void track(const stereo::StereoPair& pair);
  [[nodiscard]] Fit locate(double dt_s, Budget& budget);
  [[nodiscard]] bool good(const Fit& fit) const;
  void follow(const Fit& fit, double dt_s);
  [[nodiscard]] std::optional<Fit> find_again(const stereo::StereoPair& pair, double dt_s, Budget& budget);
  void return_to(const Fit& fit);
  void lose(double dt_s);
  void know_place(Time now);
  [[nodiscard]] bool gives_up(Time now) const;
  [[nodiscard]] bool wants_keyframe(int inliers) const;
  void make_keyframe(const stereo::StereoPair& pair, Budget& budget);
  void adjust(Budget& budget);
  void begin_apart(const stereo::StereoPair& pair, double dt_s, Budget& budget);
  void begin_map(const stereo::StereoPair& pair, Budget& budget);
  [[nodiscard]] std::span<const Feature> still_features();
  [[nodiscard]] SE3 T_odom_eye() const { return filter_.state().T_odom_base * T_base_eye_; }
  [[nodiscard]] VisualUpdate report(Time stamp) const;

  VisualOdometryConfig config_;
  stereo::StereoGeometry geometry_;
  SE3 T_base_eye_;
  FeatureTracker tracker_;
  LandmarkMap map_;
  PoseSolver solver_;
  BundleAdjuster bundle_;
  PlaceMemory places_;
  odometry::MotionPrior prior_;
  odometry::MotionFilter filter_;    // at the last pair: corrected by it, or predicted if it was lost
  odometry::MotionFilter followed_;  // at the last pair that was followed
  odometry::DriftHistory drift_;
  std::vector<Match> matches_;
  std::vector<Feature> corners_;  // of the last pair that was lost at first
  std::vector<Feature> still_;    // reused
  std::optional<Time> last_;
  Matrix6 keyframe_error_ = Matrix6::Zero();  // of the next keyframe's landmarks in common, a right perturbation
  Time last_followed_{};
  std::optional<Time> sought_since_;  // of a robot that is lost; else the last pair. None: before the first pair
  bool resuming_ = false;
  SE3 T_odom_previous_, T_odom_keyframe_;
  int keyframe_landmarks_ = 0;
};

}  // namespace cairn::visual_odometry
