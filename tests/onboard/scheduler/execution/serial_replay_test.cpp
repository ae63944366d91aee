// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/serial_replay.hpp"

#include <gmock/gmock.h>

#include "onboard/scheduler/execution/executive.hpp"
#include "onboard/scheduler/schedule_log.hpp"
#include "tests/onboard/scheduler/execution/pipeline.hpp"
#include "tests/onboard/scheduler/list_source.hpp"

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;

struct EarlyTask final : Task {
  explicit EarlyTask(std::string& order) : order_(order) {}
  void tick(Tick& tick) override {
    order_ += 'p';
    *numbers.back(tick) = 1;
    numbers.push(tick);
    if (tick.index() == 3) tick.end_of_input();
  }
  OutputPort<int> numbers{*this, "numbers"};

 private:
  std::string& order_;
};
struct LateTask final : Task {
  explicit LateTask(std::string& order) : order_(order) {}
  void tick(Tick& tick) override {
    order_ += 'c';
    while (numbers.take(tick) != nullptr) order_ += '1';
  }
  InputPort<int> numbers{*this, "numbers"};

 private:
  std::string& order_;
};

struct SerialReplayTest : ::testing::Test {
  SerialReplayTest() { graph.connect(producer.numbers, consumer.numbers, {.capacity = 8}); }
  std::string order;
  EarlyTask producer{order};
  LateTask consumer{order};
  TaskGraph graph;
  ScheduledTask& producing = graph.add({.name = "p", .rate_hz = 100, .phase_ms = 5}, producer, TaskRole::kInput);
  ScheduledTask& consuming = graph.add({.name = "c", .rate_hz = 100}, consumer);
};

TEST_F(SerialReplayTest, TicksComeInTheOrderOfTheirReleases) {
  const auto schedule = ReplaySchedule::prepare(graph, {.length = 25ms});
  ASSERT_TRUE(schedule);
  EXPECT_FALSE(replay_serially(*schedule).diverged);
  EXPECT_EQ(order, "cpc1pc1p");
}

TEST_F(SerialReplayTest, ATickThatTookWhatALaterReleaseMadeComesAfterIt) {
  const ScheduleLog log{
      {{"p", {Time{5ms}, 10ms}, {}, 2}, {"c", {Time{0ms}, 10ms}, {TickRecord{.index = 0, .slots = {1}}}, 2}}};
  const auto schedule = ReplaySchedule::prepare(graph, {.log = &log});
  ASSERT_TRUE(schedule);
  EXPECT_FALSE(replay_serially(*schedule).diverged);
  EXPECT_EQ(order, "pc1cp") << "the consumer's first tick was late then";
}

TEST_F(SerialReplayTest, ATickThatTookMoreThanThereIsShowsThatTheRecordingIsAnother) {
  const ScheduleLog log{
      {{"p", {Time{5ms}, 10ms}, {}, 1}, {"c", {Time{0ms}, 10ms}, {TickRecord{.index = 0, .slots = {2}}}, 1}}};
  const auto schedule = ReplaySchedule::prepare(graph, {.log = &log});
  ASSERT_TRUE(schedule);
  EXPECT_TRUE(replay_serially(*schedule).diverged);
  EXPECT_EQ(order, "pc1");
}

}  // namespace
}  // namespace cairn::scheduler
