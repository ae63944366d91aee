// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "drivers/recording/formats/recording.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/safety/failsafe.hpp"

namespace cairn {

[[nodiscard]] bool has_kind(std::span<const recording::SourceEntry> sources, std::string_view kind);

/// What the robot carries, as far as the failsafe watches it. An e-stop counts when the profile names its line: a GPIO
/// chip may serve the camera trigger alone.
[[nodiscard]] Fitted fitted_with(std::span<const recording::SourceEntry> sources, const RobotProfile& profile);

}  // namespace cairn
