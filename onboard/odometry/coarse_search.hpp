// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/odometry/estimation/upright.hpp"
#include "onboard/odometry/keypoint_selector.hpp"
#include "onboard/odometry/local_map/patch_map.hpp"

namespace cairn::odometry {

/// Looks for the robot around a prediction that says little: over headings and over positions in
/// the plane, by how many upright points of the scan fall on upright things of the map. Roll, pitch
/// and height stay as predicted: they hardly matter here. SecondLook searches roll and pitch, and registration finds
/// the height.
class CoarseSearch {
 public:
  static constexpr std::size_t kPlaces = 4;  ///< that are found at most

  explicit CoarseSearch(const SE3& T_base_lidar) : T_base_lidar_(T_base_lidar) {}

  /// Places that fit best, the best first, each farther from the others than registration reaches.
  /// Looks within three standard deviations of the prediction over the last `dt_s` seconds. Points
  /// are deskewed with the motion that each place means. Valid until the next call.
  [[nodiscard]] std::span<const MotionState> find(const Selection& scan, const PatchMap& map,
                                                  const MotionState& predicted, const Matrix12& covariance,
                                                  double dt_s);

 private:
  struct Place {
    double yaw = 0, x = 0, y = 0;  // change of the predicted pose, in base_link
    double score = 0, far = 0;     // squared standard deviations from the prediction
  };
  void turn(const Selection& scan, const MotionState& predicted, double yaw, double dt_s);
  void look_around(double yaw, double heading, const Eigen::Vector3d& sigma);
  void keep_best();

  SE3 T_base_lidar_;
  UprightColumns columns_;
  std::vector<Eigen::Vector2f> points_;
  std::vector<Place> places_;
  std::vector<MotionState> found_;
};

}  // namespace cairn::odometry
