// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/commands/commander.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/app/commands/commander_rig.hpp"

namespace cairn::app {
namespace {

using namespace test;

class CommanderArming : public CommanderRig {};

TEST_F(CommanderArming, ArmingIsAnsweredWhenTheMotorsAreEnabled) {
  stopped();
  say(kDesk, Verb::kArm);
  step();
  EXPECT_EQ(orders_.arm, 3U);
  EXPECT_TRUE(queue_.answers.empty());
  moving();
  drive_ = {DriveLevel::kHold, DriveCause::kEnabling, 2};
  step();
  EXPECT_TRUE(queue_.answers.empty());
  drive_.cause = DriveCause::kNoCommand;
  step();
  EXPECT_EQ(answer().outcome, Outcome::kDone);
  EXPECT_FALSE(answer().stopped);
}

TEST_F(CommanderArming, ArmingIsRefusedWithTheListOfFaults) {
  stopped({safety::Fault::kEStopOpen, safety::Fault::kLinkDown});
  say(kDesk, Verb::kArm);
  step();
  EXPECT_FALSE(orders_.arm);
  EXPECT_EQ(answer().outcome, Outcome::kRefused);
  EXPECT_EQ(answer().why.view(), "link_down, estop_open");
}

TEST_F(CommanderArming, ArmingOfAnEarlierStopIsRefused) {
  stopped();
  say(kDesk, Command{.verb = Verb::kArm, .epoch = 2, .who = {}});
  step();
  EXPECT_FALSE(orders_.arm);
  EXPECT_EQ(answer().outcome, Outcome::kRefused);
  EXPECT_EQ(answer().epoch, 3U) << "the one to ask with";
}

TEST_F(CommanderArming, ArmingThatDoesNotComeTrueIsRefusedAtLast) {
  stopped();
  say(kDesk, Verb::kArm);
  step();
  step(Commander::kArming + 1ms);
  EXPECT_EQ(answer().outcome, Outcome::kRefused);
  EXPECT_EQ(answer().why.view(), "drive: stop requested");
}

TEST_F(CommanderArming, ARobotThatMayMoveIsArmed) {
  say(kDesk, Verb::kArm);
  step();
  EXPECT_FALSE(orders_.arm);
  EXPECT_EQ(answer().outcome, Outcome::kDone);
}

}  // namespace
}  // namespace cairn::app
