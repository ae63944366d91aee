// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/guard.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cairn::drive {
namespace {

using namespace std::chrono_literals;
using Link = LinkMonitor::State;

class GuardTest : public testing::Test {
 protected:
  Guard::Inputs good() const {
    Guard::Inputs in;
    in.protocol = {true, enabled, now};
    return in;
  }
  void arm() {
    enabled = false;
    epoch = guard.arm(now, good()).value();
    guard.decide(now, good());
    enabled = true;
    guard.decide(now, good());
  }
  void go() { ASSERT_TRUE(guard.command({0.5, 0.1, epoch}, now)); }
  Order decide(const Guard::Inputs& in) { return guard.decide(now, in); }

  Guard guard;
  Time now{10s};
  bool enabled = false;
  std::uint32_t epoch = 0;
};

TEST_F(GuardTest, NothingMovesBeforeArming) {
  EXPECT_FALSE(guard.command({0.5, 0, 0}, now));
  EXPECT_FALSE(decide(good()).enable);
  EXPECT_EQ(guard.status().cause, DriveCause::kNotArmed);
}

TEST_F(GuardTest, ArmedHoldsUntilACommandComes) {
  arm();
  EXPECT_EQ(guard.status().cause, DriveCause::kNoCommand);
  const Order held = decide(good());
  EXPECT_TRUE(held.enable && held.halt);
  go();
  const Order order = decide(good());
  EXPECT_FALSE(order.halt);
  EXPECT_EQ(order.v, 0.5);
  EXPECT_EQ(order.w, 0.1);
  EXPECT_EQ(guard.status().level, DriveLevel::kNormal);
}

TEST_F(GuardTest, CommandsOfOtherEpochsAreDiscarded) {
  arm();
  for (const std::uint32_t other : {epoch - 1, epoch + 1, 0U})
    EXPECT_EQ(guard.command({1, 0, other}, now).error().code, Errc::kLimit);
  go();
  guard.stop(DriveCause::kRequested);
  const std::uint32_t before = epoch;
  arm();
  EXPECT_EQ(epoch, before + 1);
  EXPECT_TRUE(decide(good()).halt) << "the command from before the stop is gone";
  EXPECT_FALSE(guard.command({1, 0, before}, now));
  EXPECT_TRUE(decide(good()).halt);
}

TEST_F(GuardTest, ACommandThatIsNotFiniteHolds) {
  arm();
  go();
  EXPECT_EQ(guard.command({std::numeric_limits<double>::quiet_NaN(), 0, epoch}, now).error().code, Errc::kMalformed);
  EXPECT_TRUE(decide(good()).halt);
  EXPECT_EQ(guard.status().cause, DriveCause::kBadCommand);
  go();
  EXPECT_FALSE(decide(good()).halt);
}

/// Time-outs to the nanosecond: at the limit all is well, one later it is not.
TEST_F(GuardTest, TimeOutsAreExact) {
  arm();
  go();
  const Time commanded = now;
  const auto at = [&](Duration command_age, Duration feedback_age) {
    now = commanded + command_age;
    Guard::Inputs in = good();
    in.protocol.feedback = now - feedback_age;
    decide(in);
    return guard.status().cause;
  };
  EXPECT_EQ(at(500ms, 0ms), DriveCause::kNone);
  EXPECT_EQ(at(500ms + 1ns, 0ms), DriveCause::kNoCommand);
  go();
  EXPECT_EQ(at(501ms, 100ms), DriveCause::kNone);
  EXPECT_EQ(at(501ms, 100ms + 1ns), DriveCause::kFeedbackLate);
  EXPECT_EQ(at(501ms, 0ms), DriveCause::kNone) << "a hold ends by itself";
  EXPECT_EQ(at(501ms, 250ms), DriveCause::kFeedbackLate);
  EXPECT_EQ(at(501ms, 250ms + 1ns), DriveCause::kFeedbackLost);
  EXPECT_EQ(at(501ms, 0ms), DriveCause::kFeedbackLost) << "a stop does not";
}

/// Every combination of what can be wrong: the order is the one the worst of it demands, and a stop outlasts its cause.
TEST_F(GuardTest, EveryCombinationOfFaults) {
  constexpr Link kLinks[] = {Link::kUp, Link::kErrorPassive, Link::kBusOff, Link::kFailed, Link::kDown};
  constexpr DriveCause kFaults[] = {DriveCause::kNone, DriveCause::kEmergencyStop, DriveCause::kMotorFault,
                                    DriveCause::kMotorReset};
  for (const Link link : kLinks) {
    for (const DriveCause fault : kFaults) {
      for (int bits = 0; bits < 32; ++bits) {
        guard = Guard();
        arm();
        const bool commanded = (bits & 1) != 0, full = (bits & 2) != 0, late = (bits & 4) != 0, lost = (bits & 8) != 0,
                   still_enabled = (bits & 16) != 0;
        if (commanded) go();
        Guard::Inputs in = good();
        in.link = link;
        in.fault = fault;
        in.queue_full = full;
        in.protocol.enabled = still_enabled;
        if (late) in.protocol.feedback = now - 150ms;
        if (lost) in.protocol.feedback = std::nullopt;
        const Order order = decide(in);
        const bool stops = link != Link::kUp || fault != DriveCause::kNone || lost || !still_enabled;
        const bool holds = full || late || !commanded;
        EXPECT_EQ(order.enable, !stops);
        EXPECT_EQ(order.halt, stops || holds);
        EXPECT_EQ(guard.status().level, stops ? DriveLevel::kStop : holds ? DriveLevel::kHold : DriveLevel::kNormal);
        const Order after = decide(good());
        EXPECT_EQ(after.enable, !stops) << "latched";
        EXPECT_EQ(guard.command({0.5, 0, epoch}, now).has_value(), !stops);
      }
    }
  }
}

TEST_F(GuardTest, ArmingIsRefusedWhileSomethingIsWrong) {
  const auto refused = [&](auto change) {
    Guard::Inputs in = good();
    change(in);
    return !guard.arm(now, in).has_value();
  };
  for (const Link link : {Link::kErrorPassive, Link::kBusOff, Link::kFailed, Link::kDown})
    EXPECT_TRUE(refused([&](auto& in) { in.link = link; }));
  EXPECT_TRUE(refused([](auto& in) { in.protocol.ready = false; }));
  EXPECT_TRUE(refused([](auto& in) { in.protocol.feedback.reset(); }));
  EXPECT_TRUE(refused([&](auto& in) { in.protocol.feedback = now - 101ms; }));
  EXPECT_TRUE(refused([](auto& in) { in.queue_full = true; }));
  EXPECT_TRUE(refused([](auto& in) { in.fault = DriveCause::kEmergencyStop; }));
  EXPECT_FALSE(refused([](auto& in) { in.fault = DriveCause::kMotorFault; })) << "arming acknowledges it";
}

TEST_F(GuardTest, FaultsMayBeResetOnlyWhileEnabling) {
  epoch = guard.arm(now, good()).value();
  EXPECT_TRUE(decide(good()).reset);
  enabled = true;
  EXPECT_FALSE(decide(good()).reset);
  EXPECT_FALSE(decide(good()).reset);
}

TEST_F(GuardTest, EnablingThatTakesTooLongStops) {
  epoch = guard.arm(now, good()).value();
  now += 2s;
  EXPECT_TRUE(decide(good()).enable);
  now += 1ns;
  EXPECT_FALSE(decide(good()).enable);
  EXPECT_EQ(guard.status().cause, DriveCause::kEnableFailed);
}

TEST_F(GuardTest, TheFirstCauseIsKept) {
  arm();
  guard.stop(DriveCause::kEmergencyStop);
  guard.stop(DriveCause::kRequested);
  EXPECT_EQ(guard.status().cause, DriveCause::kEmergencyStop);
}

}  // namespace
}  // namespace cairn::drive
