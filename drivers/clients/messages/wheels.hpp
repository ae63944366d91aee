// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/clients/messages/record.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// Where a wheel is.
enum class WheelPlace : std::uint8_t { kLeft, kRight, kFrontLeft, kFrontRight, kRearLeft, kRearRight };
/// "left", "front_left" and so on.
[[nodiscard]] std::string_view to_string(WheelPlace place);

/// What the wheels measured: with every set of readings.
struct WheelsMessage {
  static constexpr RecordKind kKind = RecordKind::kWheels;
  static constexpr std::size_t kMost = 8;  ///< wheels

  /// One of them.
  struct Wheel {
    WheelPlace place = WheelPlace::kLeft;
    double travel_m = 0;   ///< of its rim since the run began, forward
    double speed_m_s = 0;  ///< of its rim, over the last interval between readings
  };
  Time stamp{};                                          ///< robot time: arrival of the newest reading
  double v = 0, w = 0;                                   ///< of the robot, by its wheels alone: m/s, rad/s
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of v and w
  bool slipping = false;                                 ///< the wheels contradict each other, or physics
  double radius_m = 0;                                   ///< of a wheel; 0: the profile does not say it
  std::vector<Wheel> wheels{};
};

/// Appends the body. It is: stamp (8), flags (4; bit 0 slipping), number of wheels (4), v (8), w (8), variances of v,
/// of v and w, of w (8 each), radius (8), then for each wheel place (4), zeros (4), travel (8), speed (8). Wheels
/// beyond kMost are left out.
void encode(const WheelsMessage& message, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<WheelsMessage> decode_wheels(std::span<const std::byte> body);

}  // namespace cairn::clients
