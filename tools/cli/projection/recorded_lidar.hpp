// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "drivers/recording/formats/recording.hpp"
#include "hal/monitor.hpp"
#include "hal/ports.hpp"
#include "onboard/app/profile/robot_profile.hpp"

namespace cairn::cli {

/// Index of the LiDAR among the recording's sources, the last one of several; none: it has no LiDAR.
[[nodiscard]] std::optional<std::size_t> lidar_of(const recording::Recording& recording);

/// What decodes the packets of a LiDAR, or its scans. `monitor` must outlive it. Error kInvalidConfig.
[[nodiscard]] Result<std::unique_ptr<ScanDecoder>> decoder_of(const recording::SourceEntry& entry, SourceId id,
                                                              const app::RobotProfile& profile, Monitor& monitor);

}  // namespace cairn::cli
