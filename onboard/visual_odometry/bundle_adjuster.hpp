// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

#include "hal/budget.hpp"
#include "hal/se3.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/visual_odometry/config.hpp"
#include "onboard/visual_odometry/feature_tracker.hpp"
#include "onboard/visual_odometry/landmark_map.hpp"

namespace cairn::visual_odometry {

/// Local bundle adjustment: the poses of the last keyframes and the landmarks that they show are moved together to
/// where all views fit best. The oldest keyframes keep their poses, and tie the others to the odom frame.
///
/// Gauss–Newton steps with the weights of Cauchy. Landmarks are eliminated first (Schur complement; Triggs et al.,
/// "Bundle adjustment – a modern synthesis", 2000, section 6). Sums run in the order of ids: same input, same bits.
class BundleAdjuster {
 public:
  /// `T_base_eye`: optical frame of the left eye.
  BundleAdjuster(const AdjustmentConfig& config, const stereo::StereoGeometry& geometry, const SE3& T_base_eye);

  /// Forgets all keyframes.
  void clear();
  /// Takes a keyframe. Of more than AdjustmentConfig::keyframes, the oldest is forgotten.
  void add(const SE3& T_odom_base);
  /// Takes what the newest keyframe shows of the landmarks in `map`.
  void see(std::span<const Feature> features, const LandmarkMap& map);
  /// Moves keyframes and landmarks. Every step asks `budget`, which may grant none.
  void adjust(Budget& budget);
  /// Puts the landmarks of `map` to where they are now. Those that one keyframe alone shows stay. Covariances are
  /// `inflation` times as large as the config's noise makes them.
  void place(LandmarkMap& map, double inflation) const;
  /// T_odom_base of the newest keyframe. There must be one.
  [[nodiscard]] const SE3& newest() const { return keyframes_.back(); }

 private:
  struct View {
    std::uint64_t keyframe = 0;  // counted from the first one ever
    Eigen::Vector3d seen = Eigen::Vector3d::Zero();
    bool both_eyes = true;
  };
  struct Point {
    Eigen::Vector3d p_odom = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    std::vector<View> views;
  };
  struct Row;
  struct Elimination;
  struct Equations;

  [[nodiscard]] Eigen::Index fixed() const;
  [[nodiscard]] bool row(const View& view, const Point& point, Row& out) const;
  void add_to(Equations& equations, const Point& point, Elimination& elimination) const;
  [[nodiscard]] bool step();
  [[nodiscard]] const SE3& pose_of(const View& view) const { return keyframes_[view.keyframe - oldest_]; }

  AdjustmentConfig config_;
  stereo::StereoGeometry geometry_;
  SE3 T_eye_base_;
  std::deque<SE3> keyframes_;  // T_odom_base
  std::uint64_t oldest_ = 0;   // number of keyframes_.front()
  std::map<std::uint32_t, Point> points_;
};

}  // namespace cairn::visual_odometry
