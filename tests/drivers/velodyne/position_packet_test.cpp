// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/position_packet.hpp"

#include <gtest/gtest.h>

#include "tests/support/velodyne_encoder.hpp"

namespace cairn::velodyne {
namespace {

TEST(PositionPacket, FieldsAreWhereTheManualSays) {
  auto bytes = test::encode_position(0x40833A71, 2, "$GPRMC,1*00\r\n");
  bytes[0xBB] = std::byte{45};
  bytes[0xBC] = std::byte{0xF6};  // −10
  bytes[0xCB] = std::byte{1};
  const auto p = parse_position_packet(bytes);
  ASSERT_TRUE(p);
  EXPECT_EQ(p->timestamp_us, 0x40833A71U);
  EXPECT_EQ(p->pps, PpsState::kLocked);
  EXPECT_EQ(p->top_board_c, 45);
  EXPECT_EQ(p->bottom_board_c, -10);
  EXPECT_TRUE(p->thermal_shutdown);
  EXPECT_EQ(p->nmea, "$GPRMC,1*00");
}

TEST(PositionPacket, EveryLengthButOneIsRefused) {
  for (std::size_t n = 0; n < 2000; ++n)
    EXPECT_EQ(parse_position_packet(test::Bytes(n)).has_value(), n == kPositionBytes) << n;
}

TEST(PositionPacket, PpsStates) {
  for (int byte = 0; byte < 256; ++byte) {
    const auto bytes = test::encode_position(0, static_cast<std::uint8_t>(byte), "");
    const auto p = parse_position_packet(bytes);
    EXPECT_EQ(p.has_value(), byte <= 3) << byte;
    if (!p) {
      EXPECT_EQ(p.error().offset, kPpsStateOffset);
    }
  }
}

TEST(PositionPacket, TextEndsWithItsField) {
  const auto full = test::encode_position(0, 0, std::string(500, 'x'));
  EXPECT_EQ(parse_position_packet(full)->nmea.size(), kNmeaBytes);
  EXPECT_TRUE(parse_position_packet(test::encode_position(0, 0, ""))->nmea.empty());
}

}  // namespace
}  // namespace cairn::velodyne
