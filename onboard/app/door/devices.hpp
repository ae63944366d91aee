// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/recording/formats/recording.hpp"
#include "hal/clock.hpp"
#include "hal/ports.hpp"
#include "onboard/app/profile/robot_profile.hpp"

namespace cairn::app {

/// What a device lost or what is doubtful about it, by name: "kernel_drops", 3.
using Losses = std::vector<std::pair<std::string, std::uint64_t>>;

/// A device of the robot, listening.
struct Device {
  std::string id;
  std::unique_ptr<Source> source;
  std::function<Losses()> losses;
};

/// One entry for each device that the profile has, in a fixed order: lidar, camera, thermal, depth, drive, gpio. What a
/// recording of this robot holds, and what its packets' SourceId counts.
[[nodiscard]] std::vector<recording::SourceEntry> devices_of(const RobotProfile& profile);

/// Opens the device that `entry` (of devices_of()) stands for. `clock` must outlive it. A drive is only listened to: no
/// frame is sent. Errors: those of the driver, each with its remedy.
[[nodiscard]] Result<Device> open_device(const RobotProfile& profile, const recording::SourceEntry& entry, SourceId id,
                                         const Clock& clock);
/// All of devices_of().
[[nodiscard]] Result<std::vector<Device>> open_devices_of(const RobotProfile& profile, const Clock& clock);

}  // namespace cairn::app
