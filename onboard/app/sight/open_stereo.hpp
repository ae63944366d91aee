// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "drivers/camera/camera.hpp"
#include "drivers/recording/formats/recording.hpp"
#include "hal/result.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/stereo/dense_stereo.hpp"
#include "onboard/perception/stereo/rectifier.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// What a robot without a LiDAR finds its way with.
struct StereoEyes {
  camera::Camera camera;
  stereo::Rectifier rectifier;
  stereo::DenseStereo dense;
  StereoSetup setup;
};

/// None where a LiDAR is among the sources, or no camera, or the profile forbids it. Error kInvalidConfig: the camera
/// is no calibrated stereo camera, and nothing else could tell the motion.
[[nodiscard]] Result<std::optional<StereoEyes>> open_stereo(const RobotProfile& profile,
                                                            std::span<const recording::SourceEntry> sources);

}  // namespace cairn::app
