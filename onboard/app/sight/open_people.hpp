// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "hal/monitor.hpp"
#include "hal/result.hpp"
#include "onboard/app/perception/detection_parts.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/profile/run_options.hpp"
#include "onboard/robot.hpp"

namespace cairn::app {

/// All that a run needs to follow people: what looks at pictures, and where the cameras are.
struct PeopleWatch {
  std::vector<DetectionParts> detectors;  ///< at most one for each eye
  std::optional<PeopleSetup> setup;       ///< none: nobody is followed
};

/// Whether a run with these options looks for people in the pictures of a camera of the profile, so that a live run
/// must open it.
[[nodiscard]] bool wants_eye(people::Eye eye, const RunOptions& options, const RobotProfile& profile);

/// Whether people are looked for in the clouds of a depth camera that the map gets, and not in scans: where the profile
/// says so, and with `points: auto` where there is no LiDAR.
[[nodiscard]] bool people_by_depth(const RobotProfile& profile, std::span<const recording::SourceEntry> sources);

/// Opens the detectors of the profile, or the recording's boxes.csv in their place. Where a camera, its calibration or
/// a model's file is missing, that is an event, and the other camera and the scans are there still. Where clouds are
/// asked for and there are none, that is an event, and nobody is followed. Errors: a model that is there and does not
/// fit.
[[nodiscard]] Result<PeopleWatch> open_people(const RunOptions& options, const RobotProfile& profile,
                                              const std::filesystem::path& profile_file,
                                              std::span<const recording::SourceEntry> sources, Monitor& monitor);

}  // namespace cairn::app
