// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/canopen/cia402.hpp"

#include <gtest/gtest.h>

#include <set>

#include "drivers/drive/canopen/bring_up.hpp"

namespace cairn::drive::cia402 {
namespace {

TEST(Cia402, EveryStatuswordHasTheStateOfTheTable) {
  struct Row {
    unsigned mask, value;
    State state;
  };
  constexpr Row kTable[] = {{0x4F, 0x00, State::kNotReadyToSwitchOn},  {0x4F, 0x40, State::kSwitchOnDisabled},
                            {0x6F, 0x21, State::kReadyToSwitchOn},     {0x6F, 0x23, State::kSwitchedOn},
                            {0x6F, 0x27, State::kOperationEnabled},    {0x6F, 0x07, State::kQuickStopActive},
                            {0x4F, 0x0F, State::kFaultReactionActive}, {0x4F, 0x08, State::kFault}};
  std::set<State> seen;
  for (unsigned word = 0; word <= 0xFFFF; ++word) {
    State expected = State::kUnknown;
    for (const Row& row : kTable)
      if ((word & row.mask) == row.value) expected = row.state;
    ASSERT_EQ(state_of(static_cast<std::uint16_t>(word)), expected) << word;
    seen.insert(expected);
  }
  EXPECT_EQ(seen.size(), 9U);
}

TEST(Cia402, TheWayToOperationAndToRest) {
  EXPECT_EQ(towards_operation(State::kSwitchOnDisabled), kShutdown);
  EXPECT_EQ(towards_operation(State::kReadyToSwitchOn), kSwitchOn);
  EXPECT_EQ(towards_operation(State::kSwitchedOn), kEnableOperation);
  EXPECT_EQ(towards_operation(State::kOperationEnabled), kEnableOperation);
  for (const State state : {State::kUnknown, State::kFault, State::kFaultReactionActive, State::kQuickStopActive,
                            State::kNotReadyToSwitchOn})
    EXPECT_EQ(towards_operation(state), kDisableVoltage) << to_string(state);
  for (int state = 0; state <= static_cast<int>(State::kUnknown); ++state)
    EXPECT_NE(towards_rest(static_cast<State>(state)) & 0x0FU, kEnableOperation);
  EXPECT_EQ(towards_rest(State::kOperationEnabled), kQuickStop);
}

TEST(Cia402, PdosEncodeThenDecode) {
  for (const std::int32_t value : {0, 1, -1, -1432, 954, INT32_MIN, INT32_MAX}) {
    const WheelOrder order{kEnableOperation | kHalt, value};
    EXPECT_EQ(decode_rpdo1(rpdo1(3, order)).value(), order);
    const Motion motion{value, -(value / 2)};
    EXPECT_EQ(decode_tpdo2(tpdo2(3, motion)).value(), motion);
  }
  const Status status{0x0637, kProfileVelocity, 0x8130};
  EXPECT_EQ(decode_tpdo1(tpdo1(3, status)).value(), status);
  EXPECT_EQ(decode_tpdo1(make_frame(0x181, {1, 2})).error().code, Errc::kMalformed);
}

TEST(BringUp, ConfiguresTheWatchdogAndReadsItBack) {
  Config config;
  config.wheel_radius_m = 0.1;
  config.velocity_units_per_rad_s = 100;
  const BringUp bring_up(config, 4);
  int checked = 0;
  for (const Step& step : bring_up.steps()) checked += step.kind == Step::Kind::kWriteCheck ? 1 : 0;
  EXPECT_EQ(checked, 3);
  EXPECT_EQ(bring_up.steps().front().object, kDeviceType);
  EXPECT_EQ(bring_up.steps().back().value, canopen::kTpdo2 + 4) << "the last PDO becomes valid";
  EXPECT_EQ(velocity_units(config, -0.5), -500);
  EXPECT_EQ(velocity_units(config, 1e12), 2147483647);
}

TEST(BringUp, APdoIsInvalidWhileItsMappingChanges) {
  const BringUp bring_up(Config{}, 1);
  std::set<std::uint16_t> invalid;
  for (const Step& step : bring_up.steps()) {
    const std::uint16_t i = step.object.index;
    const bool communication = (i & 0xFF00U) == 0x1400 || (i & 0xFF00U) == 0x1800;
    if (communication && step.object.sub == 1) {
      if ((step.value & 0x80000000U) != 0)
        invalid.insert(i);
      else
        invalid.erase(i);
    }
    const bool mapping = (i & 0xFF00U) == 0x1600 || (i & 0xFF00U) == 0x1A00;
    EXPECT_TRUE(!mapping || invalid.count(static_cast<std::uint16_t>(i - 0x200)) == 1);
  }
  EXPECT_TRUE(invalid.empty());
}

}  // namespace
}  // namespace cairn::drive::cia402
