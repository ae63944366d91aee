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

/// How many packets a device lost, or gave with doubtful data, by reason: "kernel_drops", 3.
using Losses = std::vector<std::pair<std::string, std::uint64_t>>;

/// An open device of the robot.
struct Device {
  std::string id;
  std::unique_ptr<Source> source;
  std::function<Losses()> losses;
};

/// One entry for each device of the profile, in a fixed order: lidar, camera, thermal, depth, drive, gpio. These are
/// the sources of a recording of this robot; the SourceId of a packet is the index in this list.
[[nodiscard]] std::vector<recording::SourceEntry> devices_of(const RobotProfile& profile);

/// Whether the depth camera alone fills the map.
[[nodiscard]] bool only_depth_maps(const RobotProfile& profile);
/// Error kInvalidConfig: no device of the profile could tell the robot's motion, or none could fill its map. Such a
/// robot can be recorded only.
[[nodiscard]] Result<void> check_devices(const RobotProfile& profile);

/// Whether the settings of LiDAR, drive and GPIO lines, and of the camera whose eyes tell the motion, fit to
/// themselves: a run without one of these does not start. Errors kInvalidConfig: those of the drivers, with the
/// device's id.
[[nodiscard]] Result<void> check_drivers(const RobotProfile& profile);

/// Opens the device of `entry`, which is one of devices_of(). `clock` must outlive it. No frame is sent to a drive.
/// Errors: those of the driver, each with its remedy; kInvalidConfig: no device is of this kind.
[[nodiscard]] Result<Device> open_device(const RobotProfile& profile, const recording::SourceEntry& entry, SourceId id,
                                         const Clock& clock);
/// Opens all of devices_of(), or none. The error names the device.
[[nodiscard]] Result<std::vector<Device>> open_devices_of(const RobotProfile& profile, const Clock& clock);

}  // namespace cairn::app
