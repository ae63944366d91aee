// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/watchdog.hpp"

#include <gtest/gtest.h>

#include "tests/support/local_socket.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;

/// Two tasks of 10 Hz and the manager that hears of them; stepped every 100 ms.
class WatchdogTest : public testing::Test {
 protected:
  void step(bool odometry, bool mapping) {
    now_ += 100ms;
    if (odometry) ++odometry_;
    if (mapping) ++mapping_;
    well_ = watchdog_.step(now_, "normal, 10 Hz");
    while (true) {
      const std::string heard = manager_.next();
      if (heard.empty()) break;
      signs_ += heard.find("WATCHDOG=1") != std::string::npos ? 1 : 0;
      last_heard_ = heard;
    }
  }

  support::TemporaryFolder folder_;
  support::DatagramListener manager_{(folder_ / "notify").string()};
  RelaxedCounter odometry_, mapping_;
  Monitor monitor_;
  Watchdog watchdog_{{{"odometry", 300ms, &odometry_}, {"mapping", 1s, &mapping_}},
                     SdNotify::open((folder_ / "notify").string()).value(),
                     1s,
                     monitor_};
  Time now_{10s};
  bool well_ = false;
  int signs_ = 0;
  std::string last_heard_;
};

TEST_F(WatchdogTest, TheManagerHearsFourSignsOfLifeWithinItsTimeOut) {
  watchdog_.ready(now_);
  EXPECT_EQ(manager_.next(), "READY=1");
  for (int i = 0; i < 60; ++i) step(true, true);
  EXPECT_TRUE(well_);
  EXPECT_GE(signs_, 18) << "6 s at steps of 100 ms: every 300 ms";
  EXPECT_EQ(last_heard_, "WATCHDOG=1\nSTATUS=normal, 10 Hz");
  EXPECT_TRUE(monitor_.events().empty());
}

TEST_F(WatchdogTest, AHungTaskIsNamedAndTheSignsOfLifeEnd) {
  for (int i = 0; i < 10; ++i) step(true, true);
  signs_ = 0;
  testing::internal::CaptureStderr();
  int steps = 0;
  do step(false, true);
  while (well_ && ++steps < 20);
  const Duration detected = 100ms * (steps + 1);
  EXPECT_LE(detected, 300ms + 100ms);
  EXPECT_NE(last_heard_.find("STATUS=task odometry hangs"), std::string::npos) << last_heard_;
  signs_ = 0;
  for (int i = 0; i < 20; ++i) step(false, true);
  EXPECT_EQ(signs_, 0) << "now the manager ends the process";
  EXPECT_NE(testing::internal::GetCapturedStderr().find("cairn: task odometry hangs"), std::string::npos);
  ASSERT_EQ(monitor_.events().size(), 1U);
  EXPECT_EQ(monitor_.events()[0].what, "task odometry hangs");
  EXPECT_EQ(monitor_.events()[0].count, 1U) << "said once";
}

TEST_F(WatchdogTest, ATaskThatGoesOnInTimeIsForgiven) {
  for (int i = 0; i < 10; ++i) step(true, true);
  for (int i = 0; i < 5; ++i) step(false, true);
  EXPECT_FALSE(watchdog_.hung().empty());
  step(true, true);
  EXPECT_TRUE(well_);
  EXPECT_TRUE(watchdog_.hung().empty());
  signs_ = 0;
  for (int i = 0; i < 10; ++i) step(true, true);
  EXPECT_GE(signs_, 3);
}

TEST_F(WatchdogTest, AStatusIsOneLine) {
  now_ += 100ms;
  watchdog_.step(now_, "normal\nWATCHDOG=trigger\x01" + std::string(1000, 'x'));
  const std::string heard = manager_.next();
  EXPECT_EQ(std::count(heard.begin(), heard.end(), '\n'), 1);
  EXPECT_LT(heard.size(), 500U);
}

}  // namespace
}  // namespace cairn::app
