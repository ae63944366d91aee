// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/commands/commander.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "onboard/app/runs/allocations.hpp"
#include "tests/onboard/app/commands/commander_rig.hpp"

namespace cairn::app {
namespace {

using namespace test;

class CommanderTest : public CommanderRig {};

TEST_F(CommanderTest, EachClientIsGreetedWithTheEpoch) {
  decision_.epoch = 8;
  stopped({safety::Fault::kEStopOpen});
  queue_.join(3, now_);
  step();
  ASSERT_EQ(queue_.answers.size(), 1U);
  EXPECT_EQ(answer().number, 0U);
  EXPECT_EQ(answer().epoch, 8U);
  EXPECT_TRUE(answer().stopped);
  EXPECT_EQ(answer().why.view(), "stop: estop_open");
}

TEST_F(CommanderTest, AVelocityIsWantedWhileItIsValid) {
  say_velocity(kDesk, 0.5);
  step();
  EXPECT_EQ(answer().outcome, Outcome::kDone);
  EXPECT_EQ(answer().v, 0.5);
  EXPECT_EQ(answer().holder.view(), "desk");
  EXPECT_EQ(speed(), 0.5);
  step(189ms);
  EXPECT_EQ(speed(), 0.5) << "199 ms old";
  step(1ms);
  EXPECT_EQ(speed(), 0.0) << "200 ms old";
  EXPECT_TRUE(commander_.wanted(now_)) << "it stands still at once";
  step(2s);
  EXPECT_FALSE(commander_.wanted(now_)) << "nobody commands any more";
}

TEST_F(CommanderTest, OneClientCommandsAtATime) {
  say_velocity(kDesk, 0.5);
  step();
  say_velocity(kJoystick, 0.9);
  step();
  EXPECT_EQ(answer().outcome, Outcome::kNotHolder);
  EXPECT_EQ(answer().holder.view(), "desk");
  EXPECT_EQ(speed(), 0.5);
}

TEST_F(CommanderTest, TheLeaseEndsWithSilenceLeavingOrGivingItBack) {
  for (int how = 0; how < 3; ++how) {
    say_velocity(kDesk, 0.5);
    step();
    if (how == 0) step(Commander::kLease + 1ms);
    if (how == 1) say(kDesk, Verb::kRelease);
    if (how == 2) queue_.leave(kDesk, now_);
    step();
    EXPECT_EQ(speed(), 0.0) << how;
    say_velocity(kJoystick, 0.25);
    step();
    EXPECT_EQ(answer().outcome, Outcome::kDone) << how;
    EXPECT_EQ(speed(), 0.25) << how;
    say(kJoystick, Verb::kRelease);
    step();
  }
}

TEST_F(CommanderTest, AnybodyMayStopTheRobot) {
  say_velocity(kDesk, 0.5);
  step();
  say(kJoystick, Verb::kStop);
  step();
  EXPECT_TRUE(orders_.stop);
  EXPECT_EQ(answer().outcome, Outcome::kDone);
  EXPECT_TRUE(answer().stopped);
  EXPECT_FALSE(commander_.wanted(now_));
}

TEST_F(CommanderTest, OnlyTheHolderMayDisarmOrHold) {
  say_velocity(kDesk, 0.5);
  step();
  for (const Verb verb : {Verb::kDisarm, Verb::kHold, Verb::kRelease}) {
    say(kJoystick, verb);
    step();
    EXPECT_EQ(answer().outcome, Outcome::kNotHolder);
    EXPECT_FALSE(orders_.stop);
  }
  say(kDesk, Verb::kHold);
  step();
  EXPECT_EQ(speed(), 0.0);
  say(kDesk, Verb::kDisarm);
  step();
  EXPECT_TRUE(orders_.stop);
}

TEST_F(CommanderTest, AFloodOfOldCommandsDoesNothing) {
  Command late{.verb = Verb::kVelocity, .v = 0.5, .who = clients::ClientName("desk")};
  late.valid_for = 100ms;
  say(kDesk, late);
  step(100ms);
  EXPECT_EQ(answer().outcome, Outcome::kStale);
  EXPECT_EQ(speed(), 0.0);
}

TEST_F(CommanderTest, ACommandFromTheFutureHasAnotherClock) {
  const Time real = now_;
  now_ += 1s;
  say_velocity(kDesk, 0.5);
  now_ = real;
  step();
  EXPECT_EQ(answer().outcome, Outcome::kStale);
}

TEST_F(CommanderTest, RepeatedAndReorderedCommandsAreStale) {
  std::vector<std::byte> bytes;
  for (const std::uint32_t number : {5U, 5U, 4U}) {
    Packet packet;
    packet.channel = kDesk;
    encode(Command{Verb::kVelocity, number, now_, 200ms, 0.1 * number, 0, 0, clients::ClientName("desk")},
           packet.bytes);
    commander_.take(packet, situation());
  }
  ASSERT_EQ(commander_.replies().size(), 2U);
  for (const auto& reply : commander_.replies()) EXPECT_EQ(reply.answer.outcome, Outcome::kStale);
  EXPECT_EQ(speed(), 0.5);
}

TEST_F(CommanderTest, WhatIsNoVelocityIsSaid) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  say_velocity(kDesk, nan);
  step();
  EXPECT_EQ(answer().outcome, Outcome::kInvalid);
  Command long_one{.verb = Verb::kVelocity, .v = 0.5, .who = {}};
  for (const Duration valid : {Duration{201ms}, Duration{-1}}) {
    long_one.valid_for = valid;
    say(kDesk, long_one);
    step();
    EXPECT_EQ(answer().outcome, Outcome::kInvalid);
  }
  EXPECT_FALSE(commander_.wanted(now_));
}

TEST_F(CommanderTest, WhatTheGuardChangesIsTold) {
  most_ = 0.2;
  decision_.mode = safety::Mode::kDegraded;
  decision_.active.set(safety::Fault::kOdometryLost);
  say_velocity(kDesk, 0.5);
  step();
  EXPECT_EQ(answer().outcome, Outcome::kLimited);
  EXPECT_EQ(answer().v, 0.2);
  EXPECT_EQ(answer().why.view(), "degraded: odometry_lost");
  moving();
  say_velocity(kDesk, 0.5);
  step();
  EXPECT_EQ(answer().outcome, Outcome::kLimited);
  EXPECT_EQ(answer().why.view(), "faster than the drive's limits");
}

TEST_F(CommanderTest, WhileStoppedAVelocityIsHeldAndForgotten) {
  stopped({safety::Fault::kEStopOpen});
  say_velocity(kDesk, 0.5);
  step();
  EXPECT_EQ(answer().outcome, Outcome::kHeld);
  EXPECT_EQ(answer().v, 0.0);
  EXPECT_TRUE(answer().stopped);
  moving();
  step();
  EXPECT_FALSE(commander_.wanted(now_)) << "what was asked before the arming";
}

TEST_F(CommanderTest, TheLaterOfTwoVelocitiesCounts) {
  say_velocity(kDesk, 0.5);
  say_velocity(kDesk, 0.25);
  step();
  ASSERT_EQ(queue_.answers.size(), 2U);
  EXPECT_EQ(answer().outcome, Outcome::kReplaced);
  EXPECT_EQ(answer().number, 1U);
  EXPECT_EQ(queue_.answers[1].answer.outcome, Outcome::kDone);
  EXPECT_EQ(speed(), 0.25);
}

TEST_F(CommanderTest, AFloodOfAnyPacketsIsBoundedAndAllocatesNothing) {
  Packet packet;
  packet.bytes.reserve(200);
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 0; i < 1000; ++i) {
    packet.channel = static_cast<std::uint16_t>(i);
    packet.bytes.assign(static_cast<std::size_t>(i % 100), static_cast<std::byte>(i % 2));
    commander_.take(packet, situation());
  }
  EXPECT_EQ(allocations_of_this_thread(), before);
  EXPECT_LE(commander_.replies().size(), 64U);
}

TEST_F(CommanderTest, AnybodyMaySayWhereTheRobotIs) {
  say_velocity(kDesk, 0.5);
  step();
  const clients::Placement place{clients::ShortText<32>("robot_1"), 3, 4, 0.5, 0.3, 0.1};
  say(kJoystick, {.verb = Verb::kPlace, .who = {}, .place = place});
  step();
  EXPECT_EQ(answer().outcome, Outcome::kDone);
  EXPECT_EQ(answer().holder.view(), "desk") << "it needs no lease";
  EXPECT_EQ(orders_.place, place);
  EXPECT_EQ(speed(), 0.5);
  step();
  EXPECT_FALSE(orders_.place) << "once";
}

TEST_F(CommanderTest, AnImpossiblePlaceIsRefused) {
  say(kDesk, {.verb = Verb::kPlace, .who = {}, .place = {.x = std::numeric_limits<double>::quiet_NaN(), .sigma_m = 1}});
  step();
  EXPECT_EQ(answer().outcome, Outcome::kInvalid);
  EXPECT_FALSE(orders_.place);
}

TEST_F(CommanderTest, WithoutATeamNobodyIsTold) {
  commander_ = Commander({.drives = true, .in_team = false});
  say(kDesk, {.verb = Verb::kPlace, .who = {}, .place = {.sigma_m = 1}});
  step();
  EXPECT_EQ(answer().outcome, Outcome::kRefused);
  EXPECT_NE(answer().why.view().find("--peers"), std::string_view::npos);
  EXPECT_FALSE(orders_.place);
}

TEST_F(CommanderTest, WithoutADriveItCanOnlyBePlaced) {
  commander_ = Commander({.drives = false, .in_team = true});
  for (const Verb verb : {Verb::kVelocity, Verb::kArm, Verb::kStop}) {
    say(kDesk, verb);
    step();
    EXPECT_EQ(answer().outcome, Outcome::kRefused);
    EXPECT_NE(answer().why.view().find("no drive"), std::string_view::npos);
  }
  say(kDesk, {.verb = Verb::kPlace, .who = {}, .place = {.sigma_m = 1}});
  step();
  EXPECT_EQ(answer().outcome, Outcome::kDone);
  EXPECT_TRUE(orders_.place);
}

}  // namespace
}  // namespace cairn::app
