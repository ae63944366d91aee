// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "hal/result.hpp"
#include "onboard/app/perception/picture_reader.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/people/people.hpp"

namespace cairn::app {

/// What the profile says of one eye.
struct EyeProfile {
  const char* name;  ///< section of the profile
  recording::SensorKind kind;
  const networks::NetworkConfig& network;
  const cameras::CameraIntrinsics& intrinsics;
  const std::vector<double>& base_xyz_rpy;
  PictureSize size;
  bool exists;
};

/// It refers to `profile`.
[[nodiscard]] EyeProfile profile_of(people::Eye eye, const RobotProfile& profile);

/// What makes pictures of the eye's packets. Errors: those of the driver's settings.
[[nodiscard]] Result<std::unique_ptr<PictureReader>> open_reader(people::Eye eye, const RobotProfile& profile,
                                                                 const PictureForm& form);

}  // namespace cairn::app
