// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/streams/streams_task.hpp"
#include "onboard/app/tasks/receive_task.hpp"

namespace cairn::app {

/// The cameras among `sources` of which clients may have pictures, as the profile describes them. Their numbers are
/// places in StreamOutlets::pictures.
[[nodiscard]] std::vector<ShownCamera> shown_cameras(const RobotProfile& profile,
                                                     std::span<const recording::SourceEntry> sources);

/// Lets receive hand the pictures of `cameras` to `outlets`.
void show(std::span<const ShownCamera> cameras, ReceiveTask& receive, StreamOutlets& outlets);

}  // namespace cairn::app
