// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/real_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "onboard/scheduler/idle_task.hpp"
#include "onboard/scheduler/threads.hpp"

namespace cairn::app {
namespace {

TEST(RealTime, EverythingThatTheMachineRefusesIsAnEvent) {
  scheduler::IdleTask idle;
  scheduler::TaskGraph graph;
  graph.add({.name = "slow"}, idle);
  graph.add({.name = "fast", .priority = 80}, idle);
  Monitor monitor;
  const std::size_t missing = scheduler::probe_privileges(80).size();
  EXPECT_EQ(become_real_time(graph, monitor), missing == 0);
  EXPECT_GE(monitor.events().size(), missing);
  for (const Event& event : monitor.events()) EXPECT_EQ(event.stage, "best effort");
}

TEST(RealTime, ACoreThatTheProcessMayNotUseIsAnEvent) {
  scheduler::IdleTask idle;
  scheduler::TaskGraph graph;
  graph.add({.name = "slow", .core = 1023}, idle);
  Monitor monitor;
  EXPECT_FALSE(become_real_time(graph, monitor));
  const bool told = std::ranges::any_of(monitor.events(), [](const Event& event) {
    return event.what.starts_with("missing: core 1023 for the task slow");
  });
  EXPECT_TRUE(told);
}

}  // namespace
}  // namespace cairn::app
