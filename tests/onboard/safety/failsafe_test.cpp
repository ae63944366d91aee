// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/failsafe.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/allocation_count.hpp"

namespace cairn::safety {
namespace {

using namespace std::chrono_literals;

Seen& seen(FailsafeInputs& in, Watched w) { return in.seen[static_cast<std::size_t>(w)]; }

/// A robot of which everything is well, stepped every 5 ms: 10 Hz scans, 50 Hz feedback, an armed drive and e-stop.
class Rig {
 public:
  explicit Rig(const FailsafeConfig& config = {}) : failsafe(config, fitted()) {
    in.now = Time{10s};
    in.estop = {true, false, false};
    in.drive = {DriveLevel::kNormal, DriveCause::kNone, 1};
    step();
    in.rearm = decision().epoch;
    step();
    EXPECT_TRUE(decision().arm);
    in.rearm.reset();
    step();
    EXPECT_EQ(decision().mode, Mode::kNormal);
  }

  void step() {
    in.now += 5ms;
    for (const Watched w : {Watched::kLidar, Watched::kCamera})
      if (alive(w) && in.now.time_since_epoch() % 100ms == 0ms) come(w);
    if (alive(Watched::kFeedback)) come(Watched::kFeedback);
    failsafe.step(in);
  }
  void run(Duration duration) {
    for (const Time end = in.now + duration; in.now < end;) step();
  }
  /// Time until the mode is there; a second at most.
  Duration until(Mode mode) {
    const Time begin = in.now;
    while (decision().mode != mode && in.now - begin < 1s) step();
    return in.now - begin;
  }
  void come(Watched w) { seen(in, w) = {in.now, seen(in, w).count + 1}; }
  void silence(Watched w, bool silent = true) { silent_[static_cast<std::size_t>(w)] = silent; }
  [[nodiscard]] const FailsafeDecision& decision() const { return failsafe.decision(); }

  FailsafeInputs in;
  Failsafe failsafe;

 private:
  static Fitted fitted() {
    Fitted f;
    f.watched = {true, true, false, false, true};
    f.drive = f.estop = true;
    return f;
  }
  [[nodiscard]] bool alive(Watched w) const { return !silent_[static_cast<std::size_t>(w)]; }
  std::array<bool, kWatched> silent_{};
};

TEST(Failsafe, ASilentLidarDegradesThenHoldsAndTwoScansBringTheRobotBack) {
  Rig rig;
  rig.run(1s);
  const Time last = seen(rig.in, Watched::kLidar).last;
  rig.silence(Watched::kLidar);
  rig.until(Mode::kDegraded);
  EXPECT_EQ(rig.in.now - last, 155ms);  // the first step after 150 ms
  EXPECT_EQ(rig.decision().cause, Fault::kLidarLate);
  EXPECT_EQ(rig.decision().max_speed_m_s, FailsafeConfig{}.degraded_speed_m_s);
  rig.until(Mode::kHold);
  EXPECT_EQ(rig.in.now - last, 505ms);
  EXPECT_EQ(rig.decision().cause, Fault::kLidarSilent);
  EXPECT_EQ(rig.decision().max_speed_m_s, 0);
  rig.run(2s);
  EXPECT_EQ(rig.decision().mode, Mode::kHold);

  rig.silence(Watched::kLidar, false);
  const std::uint64_t before = seen(rig.in, Watched::kLidar).count;
  rig.until(Mode::kDegraded);
  EXPECT_EQ(seen(rig.in, Watched::kLidar).count, before + 1);
  rig.until(Mode::kNormal);
  EXPECT_EQ(seen(rig.in, Watched::kLidar).count, before + 2);
}

TEST(Failsafe, ALidarThatGivesEveryFifthScanNeverLooksWell) {
  Rig rig;
  rig.silence(Watched::kLidar);
  rig.run(400ms);
  for (int i = 0; i < 10; ++i) {
    rig.come(Watched::kLidar);
    for (int k = 0; k < 80; ++k) {
      rig.step();
      EXPECT_NE(rig.decision().mode, Mode::kNormal);
    }
  }
}

TEST(Failsafe, WhatNeverCameIsMissingFromTheStartOn) {
  Fitted fitted;
  fitted.watched[0] = true;
  Failsafe failsafe({}, fitted);
  FailsafeInputs in;
  in.now = Time{1000s};
  EXPECT_EQ(failsafe.step(in).mode, Mode::kNormal);
  in.now += 151ms;
  EXPECT_EQ(failsafe.step(in).mode, Mode::kDegraded);
  in.now += 350ms;
  EXPECT_EQ(failsafe.step(in).mode, Mode::kHold);
}

TEST(Failsafe, FeedbackLateHoldsAndLostStops) {
  Rig rig;
  rig.silence(Watched::kFeedback);
  const Time last = rig.in.now;
  rig.until(Mode::kHold);
  EXPECT_EQ(rig.in.now - last, 105ms);
  rig.until(Mode::kStop);
  EXPECT_EQ(rig.in.now - last, 255ms);
  EXPECT_EQ(rig.decision().cause, Fault::kFeedbackLost);
  rig.silence(Watched::kFeedback, false);
  rig.run(5s);
  EXPECT_EQ(rig.decision().mode, Mode::kStop) << "a stop is latched";
  EXPECT_TRUE(rig.decision().active.empty());
}

TEST(Failsafe, CamerasAreNoReasonToSlowDownUnlessTheProfileSaysSo) {
  Rig rig;
  rig.silence(Watched::kCamera);
  rig.run(1s);
  EXPECT_EQ(rig.decision().mode, Mode::kNormal);
  EXPECT_TRUE(rig.decision().active.has(Fault::kCameraSilent));

  FailsafeConfig config;
  config.action[static_cast<std::size_t>(Fault::kCameraSilent)] = "degraded";
  Rig mission(config);
  mission.silence(Watched::kCamera);
  mission.run(1s);
  EXPECT_EQ(mission.decision().mode, Mode::kDegraded);
}

TEST(Failsafe, AnEStopLatchesUntilARequestThatNamesIt) {
  Rig rig;
  const std::uint32_t epoch = rig.decision().epoch;
  rig.in.estop = {false, false, true};
  rig.step();
  EXPECT_EQ(rig.decision().mode, Mode::kStop);
  EXPECT_EQ(rig.decision().cause, Fault::kEStopOpen);

  rig.in.rearm = epoch;  // pressed still
  rig.step();
  EXPECT_FALSE(rig.decision().arm);
  rig.in.estop.released = true;
  rig.in.rearm = epoch - 1;  // a request from before
  rig.step();
  EXPECT_FALSE(rig.decision().arm);
  rig.in.rearm.reset();
  rig.run(5s);
  EXPECT_EQ(rig.decision().mode, Mode::kStop);

  rig.in.rearm = epoch;
  rig.step();
  EXPECT_TRUE(rig.decision().arm);
  EXPECT_EQ(rig.decision().mode, Mode::kStop) << "asked for, not there yet";
  rig.in.estop.latched = false;  // gpio::EStop::rearm()
  rig.step();
  EXPECT_FALSE(rig.decision().arm) << "once";
  EXPECT_EQ(rig.decision().mode, Mode::kNormal);

  rig.in.estop = {false, false, true};
  rig.step();
  rig.in.estop = {true, false, false};
  rig.run(1s);  // the old request still comes in at every step
  EXPECT_EQ(rig.decision().mode, Mode::kStop) << "the request ended the stop it named, and no later one";
}

TEST(Failsafe, APressThatIsOverBeforeTheStepIsSeenByItsLatch) {
  Rig rig;
  rig.in.estop = {true, false, true};
  rig.step();
  EXPECT_EQ(rig.decision().mode, Mode::kStop);
  EXPECT_EQ(rig.decision().cause, Fault::kEStopOpen);
}

TEST(Failsafe, WhenADriveRefusesToArmTheRobotStaysStopped) {
  Rig rig;
  rig.in.drive = {DriveLevel::kStop, DriveCause::kMotorFault, 1};
  rig.step();
  EXPECT_EQ(rig.decision().cause, Fault::kMotorFault);
  rig.in.rearm = rig.decision().epoch;
  rig.step();
  EXPECT_TRUE(rig.decision().arm);
  rig.run(1s);
  EXPECT_EQ(rig.decision().mode, Mode::kStop);
  rig.in.rearm = rig.decision().epoch;
  rig.step();
  rig.in.drive = {DriveLevel::kHold, DriveCause::kEnabling, 2};
  rig.step();
  EXPECT_EQ(rig.decision().mode, Mode::kHold);
  rig.in.drive = {DriveLevel::kNormal, DriveCause::kNone, 2};
  rig.step();
  EXPECT_EQ(rig.decision().mode, Mode::kNormal);
}

TEST(Failsafe, WithoutADriveThereIsNothingToArm) {
  Failsafe failsafe({}, {});
  EXPECT_EQ(failsafe.step({}).mode, Mode::kNormal);
  FailsafeInputs in;
  in.faults = {Fault::kCrashLoop};
  EXPECT_EQ(failsafe.step(in).mode, Mode::kStop);
  in.faults = {};
  EXPECT_EQ(failsafe.step(in).mode, Mode::kStop);
}

TEST(Failsafe, FaultsAreRaisedAndEndedOnce) {
  Rig rig;
  rig.in.faults = {Fault::kDiskFailing, Fault::kOverload};
  rig.step();
  EXPECT_EQ(rig.decision().raised, rig.in.faults);
  rig.step();
  EXPECT_TRUE(rig.decision().raised.empty());
  rig.in.faults = {Fault::kOverload};
  rig.step();
  EXPECT_EQ(rig.decision().ended, FaultSet{Fault::kDiskFailing});
}

TEST(Failsafe, AStampFromTheFutureIsNoLicenceForSilence) {
  Rig rig;
  rig.silence(Watched::kLidar);
  rig.come(Watched::kLidar);
  seen(rig.in, Watched::kLidar).last = rig.in.now + 1h;
  rig.run(150ms);
  EXPECT_EQ(rig.decision().mode, Mode::kNormal);
  rig.run(10ms);
  EXPECT_EQ(rig.decision().mode, Mode::kDegraded);
}

TEST(Failsafe, TimeDoesNotRunBack) {
  Rig rig;
  rig.silence(Watched::kLidar);
  rig.run(300ms);
  EXPECT_EQ(rig.decision().mode, Mode::kDegraded);
  rig.in.now -= 1h;
  rig.step();
  EXPECT_EQ(rig.decision().mode, Mode::kDegraded);
}

TEST(Failsafe, EveryCauseOfTheDriveHasItsCode) {
  for (int i = 0; i <= static_cast<int>(DriveCause::kEnableFailed); ++i) {
    const auto cause = static_cast<DriveCause>(i);
    const bool nobodys =
        cause == DriveCause::kNone || cause == DriveCause::kNotArmed || cause == DriveCause::kRequested;
    EXPECT_EQ(fault_of(cause).has_value(), !nobodys) << to_string(cause);
  }
}

TEST(Failsafe, CommandsAreSlowedOnTheSameCurve) {
  FailsafeDecision decision;
  const DriveCommand command{-2, 1, 4};
  EXPECT_EQ(limited(command, decision).v, 0);
  EXPECT_EQ(limited(command, decision).w, 0);
  decision.mode = Mode::kDegraded;
  decision.max_speed_m_s = 0.5;
  EXPECT_DOUBLE_EQ(limited(command, decision).v, -0.5);
  EXPECT_DOUBLE_EQ(limited(command, decision).w, 0.25);
  EXPECT_EQ(limited(command, decision).epoch, 4U);
  decision.mode = Mode::kNormal;
  decision.max_speed_m_s = std::numeric_limits<double>::infinity();
  EXPECT_EQ(limited(command, decision).v, -2);
  EXPECT_TRUE(std::isnan(limited({std::nan(""), 0, 0}, decision).v)) << "the drive refuses it";
}

TEST(Failsafe, StepsAllocateNothing) {
  Rig rig;
  const std::size_t before = support::allocation_count();
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    rig.in.faults = FaultSet((i * 2'654'435'761U) & ((1U << kFaults) - 1));
    rig.in.rearm = rig.decision().epoch;
    rig.step();
  }
  EXPECT_EQ(support::allocation_count(), before);
}

}  // namespace
}  // namespace cairn::safety
