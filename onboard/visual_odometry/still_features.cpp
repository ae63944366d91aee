// SPDX-License-Identifier: Apache-2.0
#include "onboard/visual_odometry/still_features.hpp"

#include "onboard/perception/stereo/row_motion.hpp"
#include "onboard/visual_odometry/landmark_view.hpp"

namespace cairn::visual_odometry {

void hold_still(std::span<Feature> features, const LandmarkMap& landmarks, const MovingEyes& eyes) {
  const stereo::StereoGeometry& geometry = eyes.geometry;
  const SE3 T_base_odom = eyes.at_stamp.T_odom_base.inverse(), T_eye_base = eyes.T_base_eye.inverse();
  for (Feature& f : features) {
    const stereo::RowMotion motion{eyes.at_stamp.twist, geometry.after_stamp_s(f.left.y())};
    Eigen::Vector3d p_base;
    if (const Landmark* landmark = landmarks.find(f.id))
      p_base = T_base_odom * landmark->p_odom;
    else if (f.disparity)
      p_base = motion.at_stamp(eyes.T_base_eye * geometry.point(f.left.x(), f.left.y(), *f.disparity));
    else
      continue;
    const Eigen::Vector3d now = T_eye_base * p_base, at_row = T_eye_base * motion.at_row(p_base);
    if (now.z() < kNearest_m || at_row.z() < kNearest_m) continue;
    const Eigen::Vector3f moved = (geometry.project(now) - geometry.project(at_row)).cast<float>();
    f.left += moved.head<2>();
    if (f.disparity) *f.disparity += moved.z();
  }
}

}  // namespace cairn::visual_odometry
