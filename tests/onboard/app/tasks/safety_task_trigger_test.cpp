// SPDX-License-Identifier: Apache-2.0
// The cameras' trigger, which the safety task pulses.
#include <gtest/gtest.h>

#include "onboard/app/tasks/safety_task.hpp"
#include "tests/onboard/app/tasks/safety_neighbours.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;
using scheduler::Regime;
using scheduler::Tick;
using scheduler::TickRecord;

/// A chip whose trigger line is seen, and whose edges come back.
class TriggerChip final : public gpio::GpioLines {
 public:
  explicit TriggerChip(const Clock& clock) : GpioLines(SourceId{0}, clock) {}
  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    return take_pulse(packet) ? Poll::kPacket : Poll::kTimeout;
  }
  Result<bool> level(gpio::Line) override { return true; }
  Result<void> set(gpio::Line line, bool level) override {
    if (line == gpio::Line::kTrigger) levels.push_back(level);
    return {};
  }
  std::vector<bool> levels;
};

TEST(SafetyTaskTrigger, IsPulsedAtItsRateAndToldToWhoStampsPictures) {
  VirtualClock clock;
  TriggerChip chip(clock);
  SafetyTask task(safety::FailsafeConfig{}, safety::Fitted{});
  cairn::test::SafetyNeighbours neighbours;
  neighbours.connect(task);
  gpio::Config config;
  config.trigger_line = "trigger";
  config.trigger_rate_hz = 20;
  config.trigger_pulse_ms = 4;
  std::vector<Packet> recorded;
  task.use_lines(config, chip, SourceId{0}, &chip, [&](const Packet& packet) { recorded.push_back(packet); });
  std::vector<Time> told;
  Time now{10s};
  for (std::uint64_t n = 0; n < 500; ++n, now += 2ms) {
    clock.advance_to(now);
    TickRecord record;
    record.index = n;
    Tick tick(Regime::kLive, now, record);
    task.tick(tick);
    while (const LineEdge* edge = neighbours.lines.take(tick)) told.push_back(edge->at);
  }
  EXPECT_EQ(chip.levels.size(), 40U) << "20 pulses up and down in a second";
  ASSERT_EQ(told.size(), 20U);
  for (std::size_t i = 0; i < told.size(); ++i) EXPECT_EQ(told[i], Time(10s) + i * 50ms);
  EXPECT_EQ(recorded.size(), 40U) << "a replay has the same edges";
}

}  // namespace
}  // namespace cairn::app
