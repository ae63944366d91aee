// SPDX-License-Identifier: Apache-2.0
// Lines of a simulated chip (gpio-sim): CAIRN_TEST_GPIOCHIP names it, CAIRN_TEST_GPIOSIM the folder in sysfs that holds
// sim_gpio0, sim_gpio1, … of the same chip, through which the world moves its inputs and sees its outputs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "drivers/gpio/estop.hpp"
#include "drivers/gpio/gpio_lines.hpp"

namespace cairn::gpio {
namespace {

using namespace std::chrono_literals;

class GpioDeviceTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* chip = std::getenv("CAIRN_TEST_GPIOCHIP");
    const char* world = std::getenv("CAIRN_TEST_GPIOSIM");
    if (chip == nullptr || world == nullptr)
      GTEST_SKIP() << "CAIRN_TEST_GPIOCHIP and CAIRN_TEST_GPIOSIM name no simulated GPIO chip";
    config.chip = chip;
    world_ = world;
    config.estop_line = "0";
    config.trigger_line = "1";
    config.pps_line = "2";
  }
  void open() {
    auto opened = open_lines(config, SourceId{1}, clock);
    ASSERT_TRUE(opened) << to_string(opened.error());
    lines = std::move(*opened);
  }
  void pull(int line, bool up) const {
    std::ofstream(world_ + "/sim_gpio" + std::to_string(line) + "/pull") << (up ? "pull-up" : "pull-down");
  }
  int seen(int line) const {
    int value = -1;
    std::ifstream(world_ + "/sim_gpio" + std::to_string(line) + "/value") >> value;
    return value;
  }
  Config config;
  LiveClock clock;
  std::unique_ptr<GpioLines> lines;
  Packet packet;

 private:
  std::string world_;
};

TEST_F(GpioDeviceTest, EdgesCarryTheKernelsStamp) {
  pull(0, false);
  open();
  const Time before = clock.now();
  pull(0, true);
  ASSERT_EQ(lines->next(packet, 2s).value(), Poll::kPacket);
  const LineEvent event = decode_event(packet).value();
  EXPECT_EQ(event.line, Line::kEStop);
  EXPECT_TRUE(event.level);
  EXPECT_GE(packet.arrival, before);
  EXPECT_LE(packet.arrival, clock.now());
  EXPECT_EQ(lines->counters().unstamped, 0U);
  EXPECT_TRUE(lines->level(Line::kEStop).value());
  EXPECT_EQ(lines->next(packet, 0s).value(), Poll::kTimeout);
}

TEST_F(GpioDeviceTest, BothInputsAreHeard) {
  open();
  for (int i = 0; i < 10; ++i) {
    pull(0, i % 2 == 0);
    pull(2, i % 2 == 0);
  }
  int estop = 0, pps = 0;
  while (lines->next(packet, 100ms).value() == Poll::kPacket)
    ++(decode_event(packet)->line == Line::kEStop ? estop : pps);
  EXPECT_GE(estop, 9);
  EXPECT_GE(pps, 9);
}

TEST_F(GpioDeviceTest, TheTriggerReachesTheWorld) {
  open();
  ASSERT_TRUE(lines->set(Line::kTrigger, true));
  EXPECT_EQ(seen(1), 1);
  ASSERT_TRUE(lines->set(Line::kTrigger, false));
  EXPECT_EQ(seen(1), 0);
}

TEST_F(GpioDeviceTest, ActiveLowTurnsLevelsAround) {
  config.estop_active_low = true;
  pull(0, false);
  open();
  EXPECT_TRUE(lines->level(Line::kEStop).value());
  pull(0, true);
  EXPECT_FALSE(lines->level(Line::kEStop).value());
}

TEST_F(GpioDeviceTest, AFloodOfEdgesStillStops) {
  pull(0, true);
  open();
  EStop stop(config);
  stop.level(clock.now(), true);
  for (int i = 0; i < 3000; ++i) pull(0, i % 2 != 0);
  while (lines->next(packet, 0s).value() == Poll::kPacket) {
    const LineEvent event = decode_event(packet).value();
    stop.edge(packet.arrival, event.level, event.sequence);
  }
  stop.level(clock.now(), lines->level(Line::kEStop).value());
  EXPECT_TRUE(stop.stopped(clock.now()));
  EXPECT_TRUE(lines->level(Line::kEStop).value()) << "the last edge closed it, whatever the queue lost";
}

TEST_F(GpioDeviceTest, ASecondOwnerIsRefusedWithTheRemedy) {
  open();
  const auto second = open_lines(config, SourceId{2}, clock);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().detail.find("gpioinfo"), std::string::npos);
}

TEST_F(GpioDeviceTest, MissingChipsAndLinesAreNotFound) {
  config.estop_line = "no_such_line";
  EXPECT_EQ(open_lines(config, SourceId{1}, clock).error().code, Errc::kNotFound);
  config.chip = "no_such_chip";
  EXPECT_EQ(open_lines(config, SourceId{1}, clock).error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace cairn::gpio
