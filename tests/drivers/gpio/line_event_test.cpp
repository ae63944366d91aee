// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/line_event.hpp"

#include <gtest/gtest.h>

namespace cairn::gpio {
namespace {

TEST(LineEvent, EncodeThenDecodeIsIdentity) {
  Packet packet;
  for (const Line line : {Line::kEStop, Line::kTrigger, Line::kPps})
    for (const bool level : {false, true})
      for (const std::uint32_t sequence : {0U, 1U, 0xFFFFFFFFU}) {
        const LineEvent event{line, level, !level, sequence};
        encode_event(event, packet);
        EXPECT_EQ(decode_event(packet).value(), event);
      }
  packet.channel = 3;
  EXPECT_EQ(decode_event(packet).error().code, Errc::kMalformed);
  packet.channel = 0;
  packet.bytes[0] = std::byte{2};
  EXPECT_EQ(decode_event(packet).error().code, Errc::kMalformed);
  packet.bytes.pop_back();
  EXPECT_EQ(decode_event(packet).error().code, Errc::kTruncated);
}

TEST(LineEvent, NamesAndLinesAreInverse) {
  for (std::uint16_t i = 0; i < kLines; ++i) EXPECT_EQ(line_named(name_of(Line{i})), Line{i});
  EXPECT_FALSE(line_named("door"));
}

TEST(GpioCsv, WriteThenReadIsIdentity) {
  for (const std::int64_t stamp : {std::int64_t{0}, std::int64_t{-5}, std::int64_t{1398128223803317000}})
    for (const bool level : {false, true}) {
      std::string text;
      append_csv(text, stamp, "estop", level);
      const auto row = parse_csv(text).value().value();
      EXPECT_EQ(row.stamp_ns, stamp);
      EXPECT_EQ(row.line, "estop");
      EXPECT_EQ(row.level, level);
    }
}

TEST(GpioCsv, PassesOverHeaderCommentsAndEmptyLines) {
  for (const char* line : {"stamp_ns,line,level", "stamp_ns,line,level\r\n", "", "# note"})
    EXPECT_FALSE(parse_csv(line).value());
}

TEST(GpioCsv, NamesWhatIsWrong) {
  for (const char* line : {"x,estop,1", "1", "1,estop", "1,estop,2", "1,,1", "1,e stop,1", "1,estop,1,1", "1.5,estop,1",
                           "9999999999999999999,estop,1", "5000000000000000000,estop,1", " 1,estop,1",
                           "1,a_name_that_is_much_longer_than_any,1"}) {
    const auto row = parse_csv(line);
    ASSERT_FALSE(row) << line;
    EXPECT_EQ(row.error().code, Errc::kMalformed);
    EXPECT_LE(row.error().offset.value(), std::string_view(line).size());
  }
  EXPECT_EQ(parse_csv(std::string(kMaxCsvLine + 1, '1')).error().code, Errc::kLimit);
}

}  // namespace
}  // namespace cairn::gpio
