// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "onboard/app/sight/open_mounts.hpp"
#include "onboard/app/sight/open_people.hpp"
#include "onboard/app/sight/open_perception.hpp"
#include "onboard/app/sight/open_stereo.hpp"

namespace cairn::app {

/// All that looks at pictures.
struct Sight {
  Perception labels;
  PeopleWatch people;
  std::vector<MountParts> mounts{};  ///< cameras whose mounts are watched
  std::optional<StereoEyes> eyes{};  ///< none: a LiDAR tells the motion
};

/// Opens what the profile and the options ask for. Errors: those of open_stereo(), open_perception() and open_people().
[[nodiscard]] Result<Sight> open_sight(const RunOptions& options, const RobotProfile& profile,
                                       const std::filesystem::path& profile_file,
                                       std::span<const recording::SourceEntry> sources, Monitor& monitor);

}  // namespace cairn::app
