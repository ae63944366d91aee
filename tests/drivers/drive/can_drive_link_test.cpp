// SPDX-License-Identifier: Apache-2.0
// The drive when its bus does not work: full queue, bus-off, interface down.
#include <gtest/gtest.h>

#include "drivers/drive/can_drive.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"

namespace cairn::drive {
namespace {

using test::Robot;
using test::two_nodes;
using namespace std::chrono_literals;

TEST(CanDriveLink, AFullQueueHoldsAndTheNewestOrderReplaces) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  robot.bus.full = true;
  robot.run(30ms);
  EXPECT_EQ(robot.status().cause, DriveCause::kSendQueueFull);
  robot.bus.sent.clear();
  robot.bus.full = false;
  robot.bus.advance(5ms);
  (void)robot.drive->tick(robot.bus.now);
  int orders = 0;
  for (const CanFrame& frame : robot.bus.sent) {
    if (!frame.is(canopen::kRpdo1 + 1)) continue;
    ++orders;
    EXPECT_EQ(cia402::decode_rpdo1(frame)->target_velocity, 0) << "no stale velocity";
  }
  EXPECT_EQ(orders, 1);
}

TEST(CanDriveLink, BusOffStopsAndRestartsThriceThenGivesUp) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  robot.bus.lose = [](const CanFrame&) { return true; };
  robot.bus.inject(make_frame(kErrorFrame | kErrorBusOff, {0, 0, 0, 0, 0, 0, 0, 0}));
  robot.run(5ms);
  EXPECT_EQ(robot.status().cause, DriveCause::kBusOff);
  const auto after = [&](Duration dt) { return robot.run(dt), robot.bus.restarts; };
  EXPECT_EQ(after(90ms), 0);
  EXPECT_EQ(after(20ms), 1);
  EXPECT_EQ(after(500ms), 2);
  EXPECT_EQ(after(2s), 3);
  EXPECT_EQ(after(10s), 3);
  EXPECT_EQ(robot.drive->link_monitor().state(), LinkMonitor::State::kFailed);
  EXPECT_FALSE(robot.arm());
  EXPECT_EQ(after(200ms), 4) << "an operator asked for it";
}

TEST(CanDriveLink, RecoversFromBusOffOnlyByArming) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  robot.bus.inject(make_frame(kErrorFrame | kErrorBusOff, {0, 0, 0, 0, 0, 0, 0, 0}));
  robot.run(5ms);
  robot.bus.inject(make_frame(kErrorFrame | kErrorRestarted, {0, 0, 0, 0, 0, 0, 0, 0}));
  robot.run(2s);
  EXPECT_EQ(robot.status().cause, DriveCause::kBusOff);
  EXPECT_EQ(robot.left_speed(), 0);
  ASSERT_TRUE(robot.arm());
  robot.run(2s);
  EXPECT_NEAR(robot.left_speed(), 0.5, 1e-3);
}

TEST(CanDriveLink, AnInterfaceThatGoesDownStops) {
  Robot robot;
  robot.start();
  robot.go(0.5, 0);
  robot.run(1s);
  robot.bus.down = true;
  robot.bus.advance(5ms);
  EXPECT_FALSE(robot.drive->tick(robot.bus.now));
  EXPECT_EQ(robot.status().cause, DriveCause::kLinkDown);
  robot.run(1s);
  EXPECT_FALSE(robot.arm());
  robot.bus.down = false;
  robot.run(5s);
  EXPECT_EQ(robot.status().level, DriveLevel::kStop);
  EXPECT_TRUE(robot.arm());
}

TEST(CanDriveLink, TheTapSeesEveryPacket) {
  test::VirtualBus bus;
  std::uint64_t seen = 0;
  auto drive = CanDrive::create(two_nodes(), bus, [&](const Packet&) { ++seen; }).value();
  bus.power_on();
  for (int i = 0; i < 300; ++i) {
    bus.advance(5ms);
    (void)drive->tick(bus.now);
  }
  EXPECT_GT(seen, 100U);
  EXPECT_EQ(seen, drive->counters().received);
  EXPECT_EQ(drive->counters().rejected, 0U);
}

}  // namespace
}  // namespace cairn::drive
