// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/agilex/agilex.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "drivers/drive/agilex/agilex_chassis.hpp"
#include "drivers/drive/can/candump.hpp"
#include "tests/drivers/drive/files.hpp"

namespace cairn::drive::agilex {
namespace {

using namespace std::chrono_literals;

TEST(Agilex, EncodeThenDecodeIsIdentity) {
  const std::vector<Message> messages{SystemState{Vehicle::kEmergencyStop, Mode::kCan, 25.6, 0x0180, 1, 200},
                                      Motion{-1.5, 0.523, 0.001, -0.576},
                                      RemoteControl{0xE4, {-100, 100, 0, 7}, -5},
                                      MotorFast{7, -1432, -12.3, -2000000000},
                                      MotorSlow{3, 48.1, -20, 65, 0x21},
                                      Odometer{-63, 18},
                                      Battery{87, 99, 25.9, -10.5, 23.4}};
  for (const Message& message : messages)
    EXPECT_EQ(decode(encode(message)).value().value(), message) << message.index();
}

TEST(Agilex, CommandsAreBigEndianAndSaturate) {
  EXPECT_EQ(motion_command({0.15, -0.2, 0, 0}), make_frame(0x111, {0x00, 0x96, 0xFF, 0x38, 0, 0, 0, 0}));
  EXPECT_EQ(read_motion(motion_command({100, -100, 0, 0})), (Motion{32.767, -32.768, 0, 0}));
  EXPECT_EQ(control_mode(Mode::kCan), make_frame(0x421, {0x01}));
}

TEST(Agilex, PassesOverOthersAndRefusesWrongLengths) {
  EXPECT_FALSE(decode(make_frame(0x123, {})).value());
  EXPECT_FALSE(decode(make_frame(0x259, {})).value());
  EXPECT_EQ(decode(make_frame(0x211, {1, 2})).error().code, Errc::kMalformed);
}

std::vector<Message> messages_in(const char* name) {
  std::vector<Message> found;
  std::istringstream in(test::read_text(test::can_data(name)));
  for (std::string line; std::getline(in, line);) {
    const auto parsed = parse_candump(line).value();
    if (!parsed) continue;
    if (const auto message = decode(parsed->frame).value()) found.push_back(*message);
  }
  return found;
}

TEST(AgilexData, BunkerStandsInEmergencyStop) {
  SKIP_WITHOUT(test::can_data("agilex_bunker.candump.txt"));
  const auto found = messages_in("agilex_bunker.candump.txt");
  ASSERT_EQ(found.size(), 4U);
  const auto state = std::get<SystemState>(found[0]);
  EXPECT_EQ(state.vehicle, Vehicle::kEmergencyStop);
  EXPECT_EQ(state.mode, Mode::kStandby);
  EXPECT_DOUBLE_EQ(state.battery_v, 25.6);
  EXPECT_EQ(state.error, 0x80);
  EXPECT_EQ(std::get<Motion>(found[1]), Motion{});
}

TEST(AgilexData, HunterRests) {
  SKIP_WITHOUT(test::can_data("agilex_hunter_se.candump.txt"));
  const auto found = messages_in("agilex_hunter_se.candump.txt");
  ASSERT_EQ(found.size(), 13U);
  EXPECT_EQ(std::get<MotorFast>(found[0]), (MotorFast{0, 0, 1.5, 0x54}));
  EXPECT_EQ(std::get<Odometer>(found[4]), (Odometer{-63, 18}));
  EXPECT_DOUBLE_EQ(std::get<SystemState>(found[5]).battery_v, 25.9);
  EXPECT_DOUBLE_EQ(std::get<MotorSlow>(found[8]).voltage_v, 26.3);
  EXPECT_EQ(std::get<Motion>(found[3]), (Motion{0, 0, 0, -0.001}));
}

/// A chassis that answers: it counts, obeys the mode, and may be taken over.
class ChassisTest : public testing::Test {
 protected:
  void run(Duration duration, const Order& order) {
    for (const Time end = now + duration; now < end; now += 10ms) {
      if (!silent && (now.time_since_epoch() / 10ms) % 10 == 0) {
        ++state.count;
        ASSERT_TRUE(chassis.receive(encode(state), now));
      }
      if (!silent) {
        ASSERT_TRUE(chassis.receive(encode(Odometer{0, 0}), now));
      }
      TxQueue out;
      chassis.step(now, order, out);
      for (const CanFrame& frame : out.frames()) {
        if (frame.is(kControlModeId) && obeys) state.mode = static_cast<Mode>(frame.data[0]);
        if (frame.is(kMotionCommandId)) motion = read_motion(frame);
      }
    }
  }
  Config config = [] {
    Config c;
    c.protocol = "agilex";
    c.wheel_separation_m = 0.6;
    return c;
  }();
  Chassis chassis{config};
  SystemState state{};
  Motion motion;
  Time now{1s};
  bool obeys = true, silent = false;
  static constexpr Order kGo{true, false, false, 0.5, 0.25}, kRest{};
};

TEST_F(ChassisTest, IsToldToListenAndThenDrives) {
  run(300ms, kRest);
  EXPECT_TRUE(chassis.status().ready);
  EXPECT_FALSE(chassis.status().enabled);
  run(300ms, kGo);
  EXPECT_TRUE(chassis.status().enabled);
  EXPECT_EQ(motion, (Motion{0.5, 0.25, 0, 0}));
  run(300ms, kRest);
  EXPECT_EQ(state.mode, Mode::kStandby);
  EXPECT_EQ(motion, Motion{});
  EXPECT_EQ(chassis.take_fault(), DriveCause::kNone);
}

TEST_F(ChassisTest, ItsEmergencyStopAndItsRemoteControlAreFaults) {
  run(500ms, kGo);
  state.vehicle = Vehicle::kEmergencyStop;
  run(200ms, kGo);
  EXPECT_EQ(chassis.take_fault(), DriveCause::kEmergencyStop);
  EXPECT_FALSE(chassis.status().ready);
  state.vehicle = Vehicle::kNormal;
  run(500ms, kGo);
  chassis.take_fault();
  obeys = false;
  state.mode = Mode::kRemoteControl;
  run(200ms, kGo);
  EXPECT_EQ(chassis.take_fault(), DriveCause::kMotorFault);
}

TEST_F(ChassisTest, SilenceAndFrozenFramesAreFeedbackLost) {
  run(500ms, kGo);
  silent = true;
  run(600ms, kGo);
  EXPECT_EQ(chassis.take_fault(), DriveCause::kFeedbackLost);
  silent = false;
  run(500ms, kGo);
  chassis.take_fault();
  silent = true;
  const SystemState frozen = state;
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(chassis.receive(encode(frozen), now));
    run(10ms, kGo);
  }
  EXPECT_EQ(chassis.take_fault(), DriveCause::kFeedbackLost);
}

TEST_F(ChassisTest, AHunterIsSteered) {
  config.ackermann = true;
  chassis = Chassis{config};
  run(300ms, {true, false, false, 0.5, 0.25});
  EXPECT_NEAR(motion.steering, std::atan2(0.65, 2.0 - 0.3), 1e-3);
  EXPECT_EQ(motion.w, 0);
}

}  // namespace
}  // namespace cairn::drive::agilex
