// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/commands/reasons.hpp"

#include <gtest/gtest.h>

namespace cairn::app {
namespace {

std::string state(const safety::FailsafeDecision& decision, const DriveStatus& drive) {
  Reason why;
  tell_state(decision, drive, why);
  return std::string(why.view());
}

TEST(Reasons, NothingIsSaidWhereAllIsWell) {
  safety::FailsafeDecision decision;
  decision.mode = safety::Mode::kNormal;
  EXPECT_EQ(state(decision, {DriveLevel::kNormal, DriveCause::kNone, 1}), "");
}

TEST(Reasons, FaultsComeBeforeTheDrive) {
  safety::FailsafeDecision decision;
  decision.mode = safety::Mode::kHold;
  EXPECT_EQ(state(decision, {DriveLevel::kHold, DriveCause::kNoCommand, 1}), "drive: no command");
  decision.active.set(safety::Fault::kLidarSilent);
  EXPECT_EQ(state(decision, {DriveLevel::kHold, DriveCause::kNoCommand, 1}), "hold: lidar_silent");
}

TEST(Reasons, AllFaultsAtOnceAreCutAndNothingBreaks) {
  Reason why;
  tell_faults(safety::FaultSet((1U << safety::kFaults) - 1), why);
  EXPECT_EQ(why.view().size(), 200U);
}

}  // namespace
}  // namespace cairn::app
