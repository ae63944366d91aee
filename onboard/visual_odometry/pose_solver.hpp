// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hal/budget.hpp"
#include "hal/se3.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/visual_odometry/config.hpp"
#include "onboard/visual_odometry/landmark_map.hpp"

namespace cairn::visual_odometry {

/// A landmark and where a frame shows it.
struct Match {
  std::uint32_t id = 0;
  Eigen::Vector3d seen = Eigen::Vector3d::Zero();  ///< left pixel, disparity
  bool both_eyes = true;                           ///< false: the disparity says nothing
  double row_s = 0;                                ///< from the frame's stamp to the exposure of the pixel's row
  Landmark landmark;
};

/// Where the iteration ended.
struct Fit {
  odometry::MotionState state;
  odometry::NormalEquations equations;
  int iterations = 0;
  bool converged = false;
  int inliers = 0;         ///< matches within the gate
  double misfit = 1;       ///< mean χ² of the inliers per measured number: 1 where the noise is as configured
  double rms_px = 0;       ///< root mean square of the inliers' distance to their landmark in the left eye, pixels
  std::vector<char> fits;  ///< one per match
  std::vector<odometry::KeypointUse> uses;  ///< one per match
};

/// Finds the pose from which a frame's landmarks are where it shows them: Gauss–Newton steps towards the most probable
/// state, given the prediction. Far matches count little, by the weights of Cauchy. A landmark's own uncertainty is
/// part of the noise.
class PoseSolver {
 public:
  /// `T_base_eye`: optical frame of the left eye.
  PoseSolver(const VisualOdometryConfig& config, const stereo::StereoGeometry& geometry, const SE3& T_base_eye);

  /// Begins at `start`. `filter` holds the prediction. Every step asks `budget`; one is always made.
  [[nodiscard]] Fit align(std::span<const Match> matches, const odometry::MotionFilter& filter,
                          const odometry::MotionState& start, Budget& budget) const;
  /// The pose of most landmarks' consent, whatever was predicted: hypotheses from three matches each, drawn with a
  /// fixed seed. `start` is the first hypothesis; all have its twist.
  [[nodiscard]] SE3 vote(std::span<const Match> matches, const odometry::MotionState& start) const;

 private:
  struct Row;
  [[nodiscard]] bool row(const Match& match, const SE3& T_base_odom, const Vector6& twist, Row& out) const;
  void linearise(std::span<const Match> matches, const odometry::MotionState& at, double scale, Fit& fit) const;
  [[nodiscard]] bool from_three(std::span<const Match> matches, const int (&chosen)[3],
                                odometry::MotionState& state) const;
  [[nodiscard]] int consent(std::span<const Match> matches, const odometry::MotionState& state) const;

  VisualOdometryConfig config_;
  stereo::StereoGeometry geometry_;
  SE3 T_base_eye_, T_eye_base_;
};

}  // namespace cairn::visual_odometry
