// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/link_monitor.hpp"

#include <gtest/gtest.h>

namespace cairn::drive {
namespace {

using namespace std::chrono_literals;
using State = LinkMonitor::State;

class LinkMonitorTest : public testing::Test {
 protected:
  void error(std::uint32_t classes, std::uint8_t detail = 0) {
    monitor.receive(make_frame(kErrorFrame | classes, {0, detail, 0, 0, 0, 0, 0, 0}), now);
  }
  void ordinary() { monitor.receive(make_frame(0x181, {1}), now); }
  int restarts_until(Duration end) {
    int restarts = 0;
    for (; now < Time{end}; now += 1ms) restarts += monitor.step(now) ? 1 : 0;
    return restarts;
  }
  LinkMonitor monitor;
  Time now{0s};
};

TEST_F(LinkMonitorTest, RestartsAtTheTimesOfTheTable) {
  error(kErrorBusOff);
  EXPECT_EQ(monitor.state(), State::kBusOff);
  EXPECT_EQ(restarts_until(100ms), 0);
  EXPECT_EQ(restarts_until(101ms), 1);
  EXPECT_EQ(restarts_until(600ms), 0);
  EXPECT_EQ(restarts_until(601ms), 1);
  EXPECT_EQ(restarts_until(2600ms), 0);
  EXPECT_EQ(restarts_until(2601ms), 1);
  EXPECT_EQ(restarts_until(4600ms), 0);
  EXPECT_EQ(monitor.state(), State::kBusOff);
  EXPECT_EQ(restarts_until(60s), 0);
  EXPECT_EQ(monitor.state(), State::kFailed);
  error(kErrorRestarted);
  ordinary();
  EXPECT_EQ(monitor.state(), State::kFailed) << "latched";
  monitor.retry(now);
  EXPECT_EQ(monitor.state(), State::kBusOff);
}

TEST_F(LinkMonitorTest, RecoversByAnySignOfLife) {
  error(kErrorBusOff);
  error(kErrorRestarted);
  EXPECT_EQ(monitor.state(), State::kUp);
  error(kErrorBusOff);
  ordinary();
  EXPECT_EQ(monitor.state(), State::kUp);
  EXPECT_EQ(monitor.counters().bus_offs, 2U);
}

TEST_F(LinkMonitorTest, RepeatedBusOffsDoNotPostponeTheRestart) {
  error(kErrorBusOff);
  now += 90ms;
  error(kErrorBusOff);
  EXPECT_EQ(restarts_until(101ms), 1);
}

TEST_F(LinkMonitorTest, ErrorPassiveLastsUntilTheControllerSaysSo) {
  error(kErrorController, 0x20);
  EXPECT_EQ(monitor.state(), State::kErrorPassive);
  ordinary();
  EXPECT_EQ(monitor.state(), State::kErrorPassive);
  error(kErrorController, 0x08);
  EXPECT_EQ(monitor.state(), State::kUp) << "back at the warning level";
  error(kErrorController, 0x10);
  error(kErrorController, 0x40);
  EXPECT_EQ(monitor.state(), State::kUp);
}

TEST_F(LinkMonitorTest, ThreeFullQueuesInARow) {
  for (int i = 0; i < 2; ++i) monitor.sent(SendResult::kQueueFull);
  EXPECT_FALSE(monitor.queue_full());
  monitor.sent(SendResult::kSent);
  for (int i = 0; i < 3; ++i) monitor.sent(SendResult::kQueueFull);
  EXPECT_TRUE(monitor.queue_full());
  monitor.sent(SendResult::kSent);
  EXPECT_FALSE(monitor.queue_full());
}

TEST_F(LinkMonitorTest, DownUntilSomethingIsSentOrReceived) {
  monitor.sent(SendResult::kDown);
  EXPECT_EQ(monitor.state(), State::kDown);
  ordinary();
  EXPECT_EQ(monitor.state(), State::kUp);
}

}  // namespace
}  // namespace cairn::drive
