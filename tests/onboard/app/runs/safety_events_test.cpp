// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/safety_events.hpp"

#include <gmock/gmock.h>

#include "tests/onboard/app/tasks/safety_neighbours.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

struct SafetyEventsTest : ::testing::Test {
  SafetyEventsTest() { neighbours.connect(safety); }
  void tick() {
    scheduler::TickRecord record;
    record.index = index;
    scheduler::Tick now(scheduler::Regime::kLive, Time{1s} + static_cast<std::int64_t>(index++) * 2ms, record);
    safety.tick(now);
  }
  [[nodiscard]] std::vector<std::string> events() const {
    std::vector<std::string> list;
    for (const Event& event : monitor.events()) list.push_back(event.stage + ": " + event.what);
    return list;
  }

  Monitor monitor;
  SafetyTask safety{{}, {}};
  cairn::test::SafetyNeighbours neighbours;
  SafetyEvents safety_events{safety, monitor};
  std::uint64_t index = 0;
};

TEST_F(SafetyEventsTest, AFaultItsEndAndEveryModeAreEvents) {
  tick();
  safety.report({safety::Fault::kStageDemoted});
  tick();
  safety_events.read();
  EXPECT_EQ(safety_events.decision().mode, safety::Mode::kDegraded);
  EXPECT_TRUE(safety_events.decision().active.has(safety::Fault::kStageDemoted));
  safety.report({});
  tick();
  EXPECT_EQ(safety_events.decision().mode, safety::Mode::kDegraded) << "as of the last read";
  safety_events.read();
  EXPECT_EQ(safety_events.decision().mode, safety::Mode::kNormal);
  EXPECT_THAT(events(), ElementsAre("safety: fault: stage_demoted", "safety: mode: degraded",
                                    "safety: ended: stage_demoted", "safety: mode: normal"));
  safety_events.read();
  EXPECT_EQ(events().size(), 4U);
}

}  // namespace
}  // namespace cairn::app
