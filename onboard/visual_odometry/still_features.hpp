// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "hal/se3.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"
#include "onboard/perception/stereo/stereo_geometry.hpp"
#include "onboard/visual_odometry/feature_tracker.hpp"
#include "onboard/visual_odometry/landmark_map.hpp"

namespace cairn::visual_odometry {

/// Eyes whose rows are exposed one after the other, on a base that moves.
struct MovingEyes {
  const stereo::StereoGeometry& geometry;
  const SE3& T_base_eye;                  ///< optical frame of the left eye
  const odometry::MotionState& at_stamp;  ///< of the base, when the first row is exposed
};

/// Puts features to where they would be, had all rows been exposed with the first one. Landmarks tell how far away they
/// are; the disparities of those that have none do. What has neither stays.
void hold_still(std::span<Feature> features, const LandmarkMap& landmarks, const MovingEyes& eyes);

}  // namespace cairn::visual_odometry
