// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "hal/budget.hpp"
#include "hal/se3.hpp"
#include "hal/workers.hpp"
#include "onboard/odometry/config.hpp"
#include "onboard/odometry/estimation/degeneracy.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/odometry/estimation/normal_equations.hpp"
#include "onboard/odometry/keypoint_selector.hpp"
#include "onboard/odometry/local_map/patch_map.hpp"

namespace cairn::odometry {

/// Where the iteration ended, and the equations of its last step.
struct Fit {
  MotionState state;
  NormalEquations equations;  ///< without what they say about degenerate directions
  Degeneracy degeneracy;
  int iterations = 0;
  bool converged = false;

  /// Of the keypoints near patches, the share within 3 σ of one; 0 where there are none.
  [[nodiscard]] double inlier_ratio() const;
  /// How many keypoints fit, without those on floors and ceilings, which fit wherever the robot is.
  /// Where there is hardly anything else, as on an open field, all are counted.
  [[nodiscard]] int telling_inliers() const;
  /// The same as a share of the keypoints near patches; 0 where there are none.
  [[nodiscard]] double telling_share() const;
  /// Share of the keypoints near patches that lie on floors and ceilings; 0 where there are none.
  [[nodiscard]] double level_share() const;
  /// Root mean square distance to the patches in metres, robustly weighted.
  [[nodiscard]] double rms_m() const;
  /// Squared distance to the patches over its predicted variance, robustly weighted; 1 where
  /// nothing matched.
  [[nodiscard]] double misfit() const;
};

/// Registers the keypoints of a scan to a map: Gauss–Newton steps towards the most probable state,
/// given the prediction and the scan. The association gate begins as wide as the prediction is
/// uncertain, and narrows with every step.
class Registration {
 public:
  /// `T_base_lidar` takes a point of the sensor to base_link. `workers` must outlive the
  /// registration.
  Registration(const OdometryConfig& config, const SE3& T_base_lidar, Workers& workers);

  /// Begins at `start`. `filter` holds the prediction. Every step asks `budget`; one is always
  /// made.
  [[nodiscard]] Fit align(const Selection& scan, const PatchMap& map, const MotionFilter& filter,
                          const MotionState& start, Budget& budget);
  /// The first gate and the number of steps of an alignment whose start is known better or worse
  /// than the prediction.
  struct Effort {
    double gate_m;
    int max_steps = 1000;  ///< never more than the config's
    double share = 1;      ///< of all keypoints: a direction is degenerate if so much fewer face it
  };
  /// That of an alignment that begins at the prediction of `filter`.
  [[nodiscard]] static Effort effort_for(const MotionFilter& filter);
  [[nodiscard]] Fit align(const Selection& scan, const PatchMap& map, const MotionFilter& filter,
                          const MotionState& start, Budget& budget, const Effort& effort);
  /// How many keypoints would lie within 3 σ and `gate_m` of their patches, if the robot moved like
  /// this.
  [[nodiscard]] int inliers(const Selection& scan, const PatchMap& map, const MotionState& at, double gate_m);
  /// The same for keypoints that are not on floors or ceilings.
  [[nodiscard]] int telling_inliers(const Selection& scan, const PatchMap& map, const MotionState& at, double gate_m);
  /// Sum of the keypoints' robust weights at `at`. Unlike inliers() it also grows while points come nearer to their
  /// patches.
  [[nodiscard]] double weight(const Selection& scan, const PatchMap& map, const MotionState& at, double gate_m);
  /// Which epochs of the map the last call has used, one entry per keypoint.
  [[nodiscard]] std::span<const KeypointUse> uses() const { return linearise_.uses(); }

 private:
  Vector12 iterate(Fit& fit, const NormalEquations& all, const MotionFilter& filter, double min_facing_points) const;
  [[nodiscard]] NormalEquations linearise(const Selection& scan, const PatchMap& map, const MotionState& at,
                                          double gate_m);

  SE3 T_base_lidar_;
  Workers& workers_;
  int max_iterations_;
  double narrowest_gate_m_, widest_gate_m_;
  double min_facing_points_;
  double correlation_factor_;
  double fresh_share_;
  Linearise linearise_;
};

}  // namespace cairn::odometry
