// SPDX-License-Identifier: Apache-2.0
#include "hal/monitor.hpp"

#include <gtest/gtest.h>

namespace cairn {
namespace {

TEST(Monitor, EqualEventsAreCountedAndKeepTheirFirstAndLastTime) {
  Monitor monitor;
  monitor.event(Time{Duration{5}}, "lidar", "packet lost");
  monitor.event(Time{Duration{9}}, "lidar", "packet lost");
  monitor.event(Time{Duration{7}}, "odometry", "packet lost");
  ASSERT_EQ(monitor.events().size(), 2U);
  EXPECT_EQ(monitor.events()[0].count, 2U);
  EXPECT_EQ(monitor.events()[0].first, Time{Duration{5}});
  EXPECT_EQ(monitor.events()[0].last, Time{Duration{9}});
}

TEST(Monitor, AFloodOfDifferentEventsStaysBounded) {
  Monitor monitor;
  for (std::size_t i = 0; i < 3 * Monitor::kMaxEvents; ++i) monitor.event({}, "x", std::to_string(i));
  EXPECT_EQ(monitor.events().size(), Monitor::kMaxEvents);
  EXPECT_EQ(monitor.dropped_events(), 2 * Monitor::kMaxEvents);
}

TEST(Monitor, StagesKeepTheirAddressAndCountOverruns) {
  Monitor monitor;
  StageStats& first = monitor.stage("a", Duration{1});
  for (int i = 0; i < 100; ++i) monitor.stage("other" + std::to_string(i));
  EXPECT_EQ(&first, &monitor.stage("a"));
  { const StageTimer timing(first); }
  EXPECT_EQ(first.wall.count(), 1U);
  EXPECT_EQ(first.overruns, 1U) << "no scope lasts less than a nanosecond";
}

TEST(Monitor, ARecordedTimeCountsAsOverrunAboveTheBudgetAlone) {
  Monitor monitor;
  StageStats& bounded = monitor.stage("bounded", Duration{10});
  StageStats& free = monitor.stage("free");
  for (const int elapsed : {9, 10, 11, 500}) {
    bounded.record(Duration{elapsed});
    free.record(Duration{elapsed});
  }
  EXPECT_EQ(bounded.wall.count(), 4U);
  EXPECT_EQ(bounded.overruns, 2U);
  EXPECT_EQ(free.overruns, 0U);
}

TEST(Monitor, TheFirstDeclarationOfAStageSaysItsBudget) {
  Monitor monitor;
  monitor.stage("odometry", Duration{40});
  EXPECT_EQ(monitor.stage("odometry").budget, Duration{40});
  EXPECT_EQ(monitor.stage("odometry", Duration{7}).budget, Duration{40});
  EXPECT_EQ(monitor.stages().size(), 1U);
}

}  // namespace
}  // namespace cairn
