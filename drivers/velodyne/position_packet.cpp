// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/position_packet.hpp"

#include "hal/bytes.hpp"

namespace cairn::velodyne {

Result<PositionPacket> parse_position_packet(std::span<const std::byte> bytes) {
  if (bytes.size() != kPositionBytes) return Error{Errc::kMalformed, "position packet is not 512 bytes long"};
  const auto pps = load_le<std::uint8_t>(bytes, kPpsStateOffset);
  if (pps > static_cast<std::uint8_t>(PpsState::kError))
    return Error{Errc::kMalformed, "position packet has an unknown PPS state", {}, kPpsStateOffset, {}};
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + kNmeaOffset, kNmeaBytes);
  return PositionPacket{load_le<std::uint32_t>(bytes, kPositionTimestampOffset),
                        static_cast<PpsState>(pps),
                        load_le<std::int8_t>(bytes, kTopBoardTemperatureOffset),
                        load_le<std::int8_t>(bytes, kBottomBoardTemperatureOffset),
                        load_le<std::uint8_t>(bytes, kThermalShutdownOffset) != 0,
                        text.substr(0, text.find_first_of(std::string_view("\r\n\0", 3)))};
}

}  // namespace cairn::velodyne
