// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "onboard/app/profile/robot_profile.hpp"

namespace cairn::app {

/// Keeps the profile with a recording, as recording::kProfileFile in its folder. Error kIo.
[[nodiscard]] Result<void> keep_profile(const std::filesystem::path& recording, const RobotProfile& profile);

/// The keys whose values differ, such as "lidar.T_base_lidar".
[[nodiscard]] std::vector<std::string> differing_keys(const RobotProfile& a, const RobotProfile& b);

/// The profile of a run.
struct ChosenProfile {
  RobotProfile profile;
  std::filesystem::path file;      ///< it is of; empty: the defaults
  std::vector<std::string> notes;  ///< what a user should know of the choice, one sentence each
};

/// Chooses the profile: `config`, or else the recording's own, or else the defaults. `recording`: empty for live
/// hardware. A recording knows how its LiDAR was mounted: that goes for a profile which does not say it. The mount that
/// `config` says goes before the recording's, unless the recording holds sweeps, which are in the robot's frame. Notes
/// name what differs from the recording, and what of `config` is not used. Errors: those of the files, with the remedy.
[[nodiscard]] Result<ChosenProfile> choose_profile(const std::filesystem::path& config,
                                                   const std::filesystem::path& recording);

}  // namespace cairn::app
