// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "drivers/recording/formats/recording.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/safety/failsafe.hpp"

namespace cairn::app {

[[nodiscard]] bool has_kind(std::span<const recording::SourceEntry> sources, recording::SensorKind kind);
/// Whether scans come in: as a LiDAR's packets, or as files.
[[nodiscard]] bool has_lidar(std::span<const recording::SourceEntry> sources);

/// As what the failsafe watches a sensor for silence; none: it is not watched.
[[nodiscard]] std::optional<safety::Watched> watched_as(recording::SensorKind kind);

/// What the robot carries, as far as the failsafe watches it. An e-stop counts when the profile names its line: a GPIO
/// chip may serve the camera trigger alone. A drive counts when the profile says how to read it.
[[nodiscard]] safety::Fitted fitted_with(std::span<const recording::SourceEntry> sources, const RobotProfile& profile);

}  // namespace cairn::app
