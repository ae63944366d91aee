// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motor/power_states.hpp"

#include <gtest/gtest.h>

namespace cairn::simulator {
namespace {

namespace cia402 = drive::cia402;
using cia402::State;

PowerStates enabled() {
  PowerStates power;
  power.power_up();
  for (const std::uint16_t word : {cia402::kShutdown, cia402::kSwitchOn, cia402::kEnableOperation}) power.obey(word);
  return power;
}

TEST(PowerStates, TheWordsOfTheMasterLeadToOperationAndBackToRest) {
  PowerStates power;
  power.power_up();
  for (int i = 0; i < 3; ++i) power.obey(cia402::towards_operation(power.state()));
  EXPECT_EQ(power.state(), State::kOperationEnabled);
  power.obey(cia402::towards_rest(power.state()));
  EXPECT_EQ(power.state(), State::kQuickStopActive);
  power.at_rest();
  EXPECT_EQ(power.state(), State::kSwitchOnDisabled);
}

TEST(PowerStates, NoStateIsSkippedOnTheWayToOperation) {
  PowerStates power;
  power.power_up();
  power.obey(cia402::kEnableOperation);
  EXPECT_EQ(power.state(), State::kSwitchOnDisabled);
  power.obey(cia402::kSwitchOn);
  EXPECT_EQ(power.state(), State::kSwitchOnDisabled);
}

TEST(PowerStates, TheStatuswordSaysTheStateAsTheDriverReadsIt) {
  PowerStates power = enabled();
  EXPECT_EQ(cia402::state_of(power.statusword()), State::kOperationEnabled);
  power.quick_stop();
  EXPECT_EQ(cia402::state_of(power.statusword()), State::kQuickStopActive);
  power.fail(false, false);
  EXPECT_EQ(cia402::state_of(power.statusword()), State::kFault);
  power.boot();
  EXPECT_EQ(cia402::state_of(power.statusword()), State::kSwitchOnDisabled);
}

TEST(PowerStates, AMovingMotorBrakesBeforeItIsInFault) {
  PowerStates power = enabled();
  power.fail(true, false);
  EXPECT_EQ(power.state(), State::kFaultReactionActive);
  EXPECT_TRUE(power.braking());
  EXPECT_FALSE(power.obey(cia402::kFaultReset));
  EXPECT_EQ(power.state(), State::kFaultReactionActive) << "no word counts while it brakes";
  power.at_rest();
  EXPECT_EQ(power.state(), State::kFault);
}

TEST(PowerStates, OnlyTheEdgeOfTheResetBitEndsAFault) {
  PowerStates power = enabled();
  power.obey(cia402::kFaultReset);
  power.fail(false, false);
  EXPECT_FALSE(power.obey(cia402::kFaultReset)) << "the bit was set before";
  EXPECT_FALSE(power.obey(cia402::kDisableVoltage));
  EXPECT_TRUE(power.obey(cia402::kFaultReset));
  EXPECT_EQ(power.state(), State::kSwitchOnDisabled);
}

TEST(PowerStates, AFaultForEverEndsByPowerAlone) {
  PowerStates power = enabled();
  power.fail(false, true);
  EXPECT_FALSE(power.obey(cia402::kFaultReset));
  power.power_up();
  power.fail(false, false);
  EXPECT_TRUE(power.obey(cia402::kFaultReset));
}

TEST(PowerStates, AQuickStopEndsOperationAndNothingElse) {
  PowerStates power;
  power.power_up();
  power.quick_stop();
  EXPECT_EQ(power.state(), State::kSwitchOnDisabled);
  power = enabled();
  power.quick_stop();
  power.obey(cia402::kEnableOperation);
  EXPECT_EQ(power.state(), State::kQuickStopActive) << "until the wheel stands";
}

TEST(PowerStates, HaltIsABitOfTheWordAndNoState) {
  PowerStates power = enabled();
  power.obey(cia402::kEnableOperation | cia402::kHalt);
  EXPECT_TRUE(power.halted() && power.enabled());
  power.obey(cia402::kEnableOperation);
  EXPECT_FALSE(power.halted());
}

}  // namespace
}  // namespace cairn::simulator
