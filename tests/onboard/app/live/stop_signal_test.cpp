// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/stop_signal.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

namespace cairn::app {
namespace {

[[noreturn]] void signalled_twice(Duration patience) {
  catch_stop_signals(patience);
  if (stop_requested()) std::_Exit(2);
  (void)std::raise(SIGTERM);
  (void)std::raise(SIGTERM);
  std::_Exit(stop_requested() ? 0 : 1);
}

/// As timeout(1) does it: a recording that was killed by the second lost what it had not flushed.
TEST(StopSignalDeathTest, TwoAtOnceAskForAnOrderlyEnd) {
  EXPECT_EXIT(signalled_twice(std::chrono::hours(1)), testing::ExitedWithCode(0), "");
}

TEST(StopSignalDeathTest, ALaterOneKills) {
  EXPECT_EXIT(signalled_twice(Duration::zero()), testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace cairn::app
