// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "onboard/app/profile/robot_profile.hpp"
#include "tools/simulator/live/live_world.hpp"

namespace cairn::simulator {

/// An IPv4 address and the UDP port of a LiDAR's data packets.
struct UdpTarget {
  std::string host = "127.0.0.1";
  int data_port = velodyne::kDefaultDataPort;
  /// As far from the data port as a Velodyne's own ports are from each other.
  [[nodiscard]] int position_port() const;
};

/// A simulated robot that the user's own programs drive.
struct LiveConfig {
  std::string scene = "office";
  std::uint64_t seed = 1;           ///< of the place, the wheels and the noise
  std::optional<GroundPose> start;  ///< null: where robot 1 of simulate() starts
  LidarConfig lidar;
  WheelConfig wheels;
  UdpTarget to;
  std::string can;                ///< the bus of the motors; empty: a Unix socket in device_folder()
  std::filesystem::path estop;    ///< the file of the e-stop's line; empty: in device_folder()
  std::filesystem::path truth;    ///< gets T_world_base at 100 Hz, stamped as trajectory.tum is; empty: nowhere
  std::filesystem::path profile;  ///< gets the robot's profile; empty: nowhere
  std::optional<double> seconds;  ///< how long; null: until `stop`
};

/// Where the simulated devices are.
struct LiveDevices {
  GroundPose start;
  UdpTarget lidar;
  std::string can;
  std::filesystem::path estop;
  bool pressed = false;  ///< the e-stop is pressed already
};

/// How it goes on.
struct LiveConsole {
  std::function<bool()> stop;                       ///< whether to end
  std::function<void(const LiveDevices&)> started;  ///< the devices are there
  std::function<void(const std::string&)> say;      ///< what a person should know
};

/// What was played.
struct LiveSummary {
  double seconds = 0, distance_m = 0;
  int contacts = 0;  ///< with obstacles
  LidarPlayer::Counters lidar;
  Duration late_p50{}, late_p99{}, late_max{};  ///< packets, after they were due
  Motors::Counters motors;
  GroundPose end;
};

/// Plays a world in real time until `config.seconds` are over or `console.stop` says so. The files `truth` and
/// `profile` are there before `console.started` is called. Errors: those of LiveStage::make(), of a device and of a
/// file, each with the remedy.
Result<LiveSummary> simulate_live(const LiveConfig& config, const LiveConsole& console);

/// The profile of a robot whose devices are these. Without real-time rights (`real_time` false), safety and drive have
/// periods that an ordinary thread can keep: otherwise each late tick holds the robot.
[[nodiscard]] app::RobotProfile live_profile(const LiveConfig& config, const LiveDevices& devices, bool real_time);

}  // namespace cairn::simulator
