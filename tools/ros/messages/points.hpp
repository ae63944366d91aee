// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/client/scan_assembly.hpp"
#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

/// A deskewed scan in base_link at its end: x y z as float32 in metres, unordered (height 1).
[[nodiscard]] PointCloud2 points_of(const client::ScanMessage& scan, const Frames& frames, Duration utc_offset,
                                    Arena& arena);

/// A thermal cloud in base_link at the picture's time: x y z in metres and temperature in °C, or counts where the
/// camera does not tell their unit; float32, unordered.
[[nodiscard]] PointCloud2 points_of(const client::ThermalMessage& cloud, const Frames& frames, Duration utc_offset,
                                    Arena& arena);

}  // namespace cairn::ros
