// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/stop_signal.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <initializer_list>

namespace cairn::app {
namespace {

[[noreturn]] void signalled(std::initializer_list<int> signals) {
  catch_stop_signals();
  if (stop_requested()) std::_Exit(2);
  for (const int number : signals) (void)std::raise(number);
  std::_Exit(stop_requested() ? 0 : 1);
}

/// As timeout(1) does it: a run that was killed by the second one lost its map.
TEST(StopSignalDeathTest, AnyNumberAsksForAnOrderlyEnd) {
  EXPECT_EXIT(signalled({SIGTERM}), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(signalled({SIGINT, SIGTERM, SIGINT, SIGINT}), testing::ExitedWithCode(0), "");
}

TEST(StopSignalDeathTest, AnotherSignalKills) {
  EXPECT_EXIT(signalled({SIGINT, SIGQUIT}), testing::KilledBySignal(SIGQUIT), "");
}

TEST(StopSignal, TheErrorNamesWhatWasInterruptedAndTheRemedy) {
  EXPECT_EQ(to_string(interrupted("recording", "start it again")),
            "recording: interrupted before the end: start it again");
}

}  // namespace
}  // namespace cairn::app
