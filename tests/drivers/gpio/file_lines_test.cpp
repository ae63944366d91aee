// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/file_lines.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/allocation_count.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::gpio {
namespace {

using namespace std::chrono_literals;

class FileLinesTest : public testing::Test {
 protected:
  void SetUp() override {
    config.chip = "file:" + folder.path().string();
    config.estop_line = "estop";
    clock.advance_to(Time(5s));
    write("estop", "1\n");
  }
  void write(const std::string& line, const std::string& text) const { std::ofstream(folder / line) << text; }
  std::unique_ptr<GpioLines> open() {
    auto opened = open_lines(config, SourceId{3}, clock);
    EXPECT_TRUE(opened) << to_string(opened.error());
    return std::move(*opened);
  }

  support::TemporaryFolder folder;
  Config config;
  VirtualClock clock;
  Packet packet;
};

TEST_F(FileLinesTest, EachChangeIsOneEdge) {
  const auto lines = open();
  EXPECT_EQ(lines->next(packet, 0s).value(), Poll::kTimeout);
  write("estop", "0\n");
  clock.advance_to(Time(6s));
  ASSERT_EQ(lines->next(packet, 0s).value(), Poll::kPacket);
  EXPECT_EQ(decode_event(packet).value(), (LineEvent{Line::kEStop, false, false, 0}));
  EXPECT_EQ(packet.arrival, Time(6s));
  EXPECT_EQ(packet.source, SourceId{3});
  EXPECT_EQ(lines->next(packet, 0s).value(), Poll::kTimeout);
  write("estop", "1");
  ASSERT_EQ(lines->next(packet, 0s).value(), Poll::kPacket);
  EXPECT_TRUE(decode_event(packet)->level);
  EXPECT_EQ(lines->counters().events, 2U);
}

TEST_F(FileLinesTest, AFileThatIsReplacedIsReadAnew) {
  const auto lines = open();
  write("new", "0");
  std::filesystem::rename(folder / "new", folder / "estop");
  EXPECT_FALSE(lines->level(Line::kEStop).value());
}

TEST_F(FileLinesTest, ActiveLowTurnsLevelsAround) {
  config.estop_active_low = true;
  const auto lines = open();
  EXPECT_FALSE(lines->level(Line::kEStop).value());
  write("estop", "0");
  EXPECT_TRUE(lines->level(Line::kEStop).value());
}

TEST_F(FileLinesTest, ALineThatIsGoneOrSenselessHasNoLevelAndNoEdge) {
  const auto lines = open();
  for (const char* senseless : {"x", "-1", " 1", "\xff\n"}) {
    write("estop", senseless);
    EXPECT_EQ(lines->level(Line::kEStop).error().code, Errc::kMalformed) << senseless;
    EXPECT_EQ(lines->next(packet, 0s).value(), Poll::kTimeout) << senseless;
  }
  std::filesystem::remove(folder / "estop");
  EXPECT_EQ(lines->level(Line::kEStop).error().code, Errc::kNotFound);
  std::filesystem::create_directory(folder / "estop");
  EXPECT_EQ(lines->level(Line::kEStop).error().code, Errc::kIo);
  EXPECT_EQ(lines->next(packet, 0s).value(), Poll::kTimeout);
}

/// The safety task asks 500 times a second, whatever became of the line.
TEST_F(FileLinesTest, ALineThatIsGoneCostsNoAllocation) {
  config.trigger_line = "trigger";
  config.pps_line.clear();
  const auto lines = open();
  packet.bytes.reserve(256);
  const auto allocations = [&] {
    const std::size_t before = support::allocation_count();
    for (const bool level : {true, false}) (void)lines->pulse(Line::kTrigger, level);
    for (int i = 0; i < 3; ++i) (void)lines->level(Line::kEStop), (void)lines->next(packet, 0s);
    (void)lines->level(Line::kPps);
    return support::allocation_count() - before;
  };
  EXPECT_EQ(allocations(), 0U);
  write("estop", "x");
  EXPECT_EQ(allocations(), 0U) << "senseless";
  std::filesystem::remove_all(folder.path());
  EXPECT_EQ(allocations(), 0U) << "gone";
}

/// `echo 0 > estop` empties the file before it writes. An e-stop that is read just then is open, and not lost.
TEST_F(FileLinesTest, AnEmptyFileIsALineThatIsNotActive) {
  for (const bool active_low : {false, true}) {
    config.estop_active_low = active_low;
    write("estop", active_low ? "0" : "1");
    const auto lines = open();
    ASSERT_TRUE(lines->level(Line::kEStop).value());
    write("estop", "");
    EXPECT_FALSE(lines->level(Line::kEStop).value());
    ASSERT_EQ(lines->next(packet, 0s).value(), Poll::kPacket);
    EXPECT_FALSE(decode_event(packet)->level);
  }
}

TEST_F(FileLinesTest, OutputsAreFilesToo) {
  config.trigger_line = "trigger";
  const auto lines = open();
  const auto text = [&] {
    std::string all;
    std::getline(std::ifstream(folder / "trigger"), all);
    return all;
  };
  EXPECT_EQ(text(), "0");
  ASSERT_TRUE(lines->set(Line::kTrigger, true));
  EXPECT_EQ(text(), "1");
  EXPECT_EQ(lines->next(packet, 0s).value(), Poll::kTimeout) << "an output makes no edges";
}

TEST_F(FileLinesTest, PulsesComeBackAsEdgesWithTheirTime) {
  config.trigger_line = "trigger";
  const auto lines = open();
  for (const bool level : {true, false}) {
    clock.advance_to(Time(level ? 7s : 8s));
    ASSERT_TRUE(lines->pulse(Line::kTrigger, level));
  }
  for (const bool level : {true, false}) {
    ASSERT_EQ(lines->next(packet, 0s).value(), Poll::kPacket);
    EXPECT_EQ(decode_event(packet).value(), (LineEvent{Line::kTrigger, level, false, 0}));
    EXPECT_EQ(packet.arrival, Time(level ? 7s : 8s));
  }
  EXPECT_EQ(lines->next(packet, 0s).value(), Poll::kTimeout);
  EXPECT_EQ(lines->pulse(Line::kPps, true).error().code, Errc::kNotFound);
  EXPECT_EQ(lines->next(packet, 0s).value(), Poll::kTimeout) << "what was not set is no edge";
}

TEST_F(FileLinesTest, WhatIsMissingIsSaidWithTheRemedy) {
  config.pps_line = "pps";
  const auto missing = open_lines(config, SourceId{0}, clock);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kNotFound);
  EXPECT_NE(to_string(missing.error()).find("simulate --live"), std::string::npos);
  config.chip = "file:";
  EXPECT_EQ(open_lines(config, SourceId{0}, clock).error().code, Errc::kInvalidConfig);
}

TEST_F(FileLinesTest, ALineThatIsNotConfiguredIsNotFound) {
  const auto lines = open();
  EXPECT_EQ(lines->level(Line::kPps).error().code, Errc::kNotFound);
  EXPECT_EQ(lines->set(Line::kTrigger, true).error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace cairn::gpio
