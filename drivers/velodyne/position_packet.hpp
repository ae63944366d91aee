// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/velodyne/packet.hpp"
#include "hal/result.hpp"

namespace cairn::velodyne {

/// A position ("telemetry") packet.
struct PositionPacket {
  std::uint32_t timestamp_us = 0;  ///< device time, µs past the hour
  PpsState pps = PpsState::kAbsent;
  int top_board_c = 0, bottom_board_c = 0;  ///< °C
  bool thermal_shutdown = false;
  std::string_view nmea;  ///< up to the first CR, LF or NUL, in the packet's memory; empty without a GPS receiver
};

/// Reads a position packet. Error: kMalformed with the offset (wrong length, unknown PPS state).
[[nodiscard]] Result<PositionPacket> parse_position_packet(std::span<const std::byte> bytes);

}  // namespace cairn::velodyne
