// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/clients/messages/record.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// The first record of robot.sock: who the robot is. Texts are cut at kMaxText bytes, sensors at kMaxSensors.
struct HelloMessage {
  static constexpr RecordKind kKind = RecordKind::kHello;
  static constexpr std::size_t kMaxText = 64, kMaxSensors = 16;

  std::string robot;
  std::uint64_t robot_id = 0;  ///< in its team; 0: it is in none
  std::uint64_t session = 0;   ///< of this run: another one with every start
  Duration realtime_offset{};  ///< added to a stamp it gives UTC
  double resolution_m = 0;     ///< edge of a voxel of both maps, above 0
  /// Where a sensor is mounted.
  struct Sensor {
    std::string name;
    SE3 T_base_sensor;
  };
  std::vector<Sensor> sensors{};
};

/// Appends the body. It is: session (8), robot's id (8), offset (8), resolution (8), name (text), number of sensors
/// (1); for each its name (text) and pose (7 × 8).
void encode(const HelloMessage& message, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<HelloMessage> decode_hello(std::span<const std::byte> body);

}  // namespace cairn::clients
