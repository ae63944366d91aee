// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "hal/monitor.hpp"
#include "onboard/app/perception/mount_task.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/profile/run_options.hpp"

namespace cairn::app {

/// Whether a run with these options may watch mounts, if it has pictures.
[[nodiscard]] bool wants_mounts(const RunOptions& options, const RobotProfile& profile);

/// The cameras among `sources` whose mounts are watched: those that are calibrated. None with `--networks off`, or
/// with perception.mount.rate_hz 0, or without a LiDAR. One whose intrinsics do not fit its pictures is an event, and
/// is not watched.
[[nodiscard]] std::vector<MountParts> open_mounts(const RunOptions& options, const RobotProfile& profile,
                                                  std::span<const recording::SourceEntry> sources, Monitor& monitor);

}  // namespace cairn::app
