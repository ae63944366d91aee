// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/candump.hpp"

#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "tests/drivers/drive/files.hpp"

namespace cairn::drive {
namespace {

CandumpLine parsed(std::string_view line) {
  const auto result = parse_candump(line);
  EXPECT_TRUE(result && *result) << line << ": " << (result ? "no frame" : to_string(result.error()));
  return result && *result ? **result : CandumpLine{};
}
CanFrame with(CanFrame frame, std::uint32_t id) {
  frame.id = id;
  return frame;
}
const CanFrame kTwo = make_frame(0x123, {0x11, 0x22});

TEST(Candump, ReadsLogLines) {
  const CandumpLine line = parsed("(1398128223.803317) can0 123#1122\r\n");
  EXPECT_EQ(line.stamp->time_since_epoch().count(), 1398128223803317000);
  EXPECT_EQ(line.interface, "can0");
  EXPECT_EQ(line.frame, kTwo);
  EXPECT_FALSE(line.direction);
  EXPECT_EQ(parsed("(1.123456789)   vcan12 123#11.22").stamp->time_since_epoch().count(), 1123456789);
  EXPECT_EQ(parsed("(1.5) can0 123#1122 T").direction, Direction::kSent);
  EXPECT_EQ(parsed("(1) can0 123#1122 R").direction, Direction::kReceived);
  EXPECT_EQ(parsed("(1.0) can0 00000123#1122").frame, with(kTwo, 0x123 | kExtended));
}

TEST(Candump, ReadsSpecialLogFrames) {
  EXPECT_EQ(parsed("(1.0) can0 123#R").frame, make_frame(0x123 | kRemote, {}));
  EXPECT_EQ(parsed("(1.0) can0 123#R5").frame.length, 5);
  const CanFrame error = parsed("(1.0) can0 20000040#0000000000000000").frame;
  EXPECT_TRUE(error.error());
  EXPECT_EQ(error.id & kExtendedMask, 0x40U);
  const CanFrame fd = parsed("(1.0) can0 123##3112233445566778899AABBCC").frame;
  EXPECT_TRUE(fd.fd);
  EXPECT_EQ(fd.fd_flags, kFdBitRateSwitch | kFdErrorState);
  EXPECT_EQ(fd.length, 12);
  EXPECT_EQ(parsed("(1.0) can0 123#1122334455667788_F").frame.raw_dlc, 15);
  EXPECT_EQ(parse_candump("(1.0) can0 45123#81:00:12345678#1122").error().code, Errc::kUnsupported);
}

TEST(Candump, ReadsConsoleLines) {
  for (const char* line :
       {"  can0  123   [2]  11 22", "can0 123 [2] 11 22", " (000.304418)  can0  123   [2]  11 22",
        " (2024-01-02 03:04:05.123456)  can0  123   [2]  11 22",
        " (1699999999.123456)  can0  RX - -  123   [2]  11 22   '.\"'", "  can0       123   [2]  00010001 00100010",
        "  can0  123   [2]  22`11", "  \x1b[34mcan0\x1b[0m  123   [2]  11 22\x1b[0m"}) {
    EXPECT_EQ(parsed(line).frame, kTwo) << line;
    EXPECT_EQ(parsed(line).interface, "can0") << line;
  }
  EXPECT_EQ(parsed(" (2024-01-02 03:04:05.5) can0 123 [0]").stamp->time_since_epoch(),
            std::chrono::milliseconds(1704164645500));
  EXPECT_EQ(parsed("can0  TX B E  123  [02]  11 22").direction, Direction::kSent);
  EXPECT_EQ(parsed("can0  TX B E  123  [02]  11 22").frame.fd_flags, 3);
  EXPECT_EQ(parsed("can0  123   [4]  remote request").frame.length, 4);
  EXPECT_TRUE(parsed("can0  20000004   [8]  00 20 00 00 00 00 88 00   ERRORFRAME").frame.error());
  EXPECT_EQ(parsed("can0  123   {B}  01 02 03 04 05 06 07 08").frame.raw_dlc, 11);
}

TEST(Candump, PassesOverLinesWithoutFrame) {
  for (const char* line :
       {"", "   ", "# comment", "DROPCOUNT: dropped 3 CAN frames", "\tcontroller-problem{tx-passive}"})
    EXPECT_FALSE(parse_candump(line).value()) << line;
}

TEST(Candump, NamesWhatIsWrong) {
  for (const char* line : {"(1.0) can0",
                           "(1.0) can0 12#11",
                           "(1.0) can0 800#11",
                           "(1.0) can0 123#1",
                           "(1.0) can0 123#112233445566778899",
                           "(1.0) can0 123##1112233445566778899",
                           "(1.0) can0 123#R9",
                           "(1.0) can0 123#11_9",
                           "(1.0) can0 123#11 X",
                           "(x) can0 123#11",
                           "(1.0 can0 123#11",
                           "(1.0000000000) can0 123#11",
                           "(99999999999.0) can0 123#11",
                           "(2024-13-02 03:04:05.1) can0 123#11",
                           "can0 123 [3] 11 22",
                           "can0 123 [1] 11 22",
                           "can0 123 [9] 11",
                           "can0 123 11",
                           "a_name_that_is_too_long 123 [1] 11",
                           "can0 RX - 123 [1] 11",
                           "can0 20000004 [01] 11",
                           "garbage"}) {
    const auto result = parse_candump(line);
    ASSERT_FALSE(result) << line;
    EXPECT_EQ(result.error().code, Errc::kMalformed) << line;
    EXPECT_FALSE(result.error().cause.empty());
    EXPECT_LE(result.error().offset.value(), std::string_view(line).size());
  }
  EXPECT_EQ(parse_candump(std::string(kMaxCandumpLine + 1, 'x')).error().code, Errc::kLimit);
}

TEST(Candump, WriteThenReadIsIdentity) {
  std::mt19937 random(2);
  constexpr std::array kFdLengths{0UL, 5UL, 8UL, 12UL, 48UL, 64UL};
  for (int i = 0; i < 2000; ++i) {
    CanFrame frame;
    frame.fd = random() % 3 == 0;
    frame.id = random() % 2 == 0 ? random() & kStandardMask : (random() & kExtendedMask) | kExtended;
    if (!frame.fd && random() % 6 == 0) frame.id = kErrorFrame | (random() & kStandardMask);
    frame.length = static_cast<std::uint8_t>(frame.fd ? kFdLengths[random() % kFdLengths.size()] : random() % 9U);
    if (frame.fd) frame.fd_flags = static_cast<std::uint8_t>(random() % 16);
    if (!frame.fd && !frame.error() && random() % 5 == 0) frame.id |= kRemote;
    if (!frame.fd && frame.length == 8 && random() % 2 == 0)
      frame.raw_dlc = static_cast<std::uint8_t>(9 + random() % 7);
    for (std::size_t b = 0; b < frame.length && !frame.remote(); ++b)
      frame.data[b] = static_cast<std::uint8_t>(random());
    const Time stamp{std::chrono::microseconds(random())};
    const std::optional<Direction> direction =
        random() % 2 == 0 ? std::nullopt : std::optional(static_cast<Direction>(random() % 2));
    std::string text;
    append_candump(text, stamp, "vcan0", frame, direction);
    const CandumpLine line = parsed(text);
    EXPECT_EQ(line.frame, frame) << text;
    EXPECT_EQ(line.stamp, stamp);
    EXPECT_EQ(line.direction, direction);
  }
}

TEST(CandumpData, SampleRoundTripsByteForByte) {
  const auto path = test::can_data("sample.candump.log");
  SKIP_WITHOUT(path);
  const std::string text = test::read_text(path);
  std::istringstream in(text);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    const CandumpLine p = parsed(line);
    append_candump(out, *p.stamp, p.interface, p.frame, p.direction);
  }
  EXPECT_EQ(out, text);
}

TEST(CandumpData, EveryLineOfTheExcerptsIsRead) {
  const std::pair<const char*, int> files[] = {{"agilex_bunker.candump.txt", 4},
                                               {"agilex_hunter_se.candump.txt", 13},
                                               {"cia402_simulated_drive_velocity.candump.txt", 20},
                                               {"cia402_two_node_bringup.candump.txt", 70}};
  for (const auto& [name, frames] : files) {
    const auto path = test::can_data(name);
    SKIP_WITHOUT(path);
    std::istringstream in(test::read_text(path));
    int count = 0;
    for (std::string line; std::getline(in, line);) {
      const auto result = parse_candump(line);
      ASSERT_TRUE(result) << name << ": " << line << to_string(result.error());
      count += *result ? 1 : 0;
    }
    EXPECT_EQ(count, frames) << name;
  }
}

}  // namespace
}  // namespace cairn::drive
