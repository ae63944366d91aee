// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/task_graph.hpp"

#include <gmock/gmock.h>

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

struct NumberMaker final : Task {
  void tick(Tick& /*tick*/) override {}
  OutputPort<int> numbers{*this, "numbers"};
};
struct NumberTaker final : Task {
  void tick(Tick& /*tick*/) override {}
  InputPort<int> numbers{*this, "numbers"};
};

struct TaskGraphTest : ::testing::Test {
  NumberMaker producer;
  NumberTaker consumer;
  TaskGraph graph;
};

TEST_F(TaskGraphTest, AChannelCarriesValuesFromPortToPort) {
  const ScheduledTask& from = graph.add({.name = "from"}, producer, TaskRole::kInput);
  const ScheduledTask& to = graph.add({.name = "to"}, consumer);
  graph.connect(producer.numbers, consumer.numbers, {.capacity = 2});
  EXPECT_TRUE(from.is_input());
  EXPECT_TRUE(from.inputs.empty());
  EXPECT_THAT(to.inputs, ElementsAre(&consumer.numbers));

  TickRecord record;
  Tick tick(Regime::kLive, Time{}, record);
  *producer.numbers.back(tick) = 7;
  producer.numbers.push(tick);
  EXPECT_EQ(to.inputs.front()->channel()->fill().waiting, 1U);
  EXPECT_EQ(*consumer.numbers.take(tick), 7);
}

TEST_F(TaskGraphTest, IsPrintedAsTasksAndChannels) {
  TaskSpec reader{.name = "reader", .rate_hz = 500, .soft_ms = 0.2, .hard_ms = 1, .priority = 80};
  graph.add(reader, producer, TaskRole::kInput);
  graph.add({.name = "writer", .rate_hz = 20, .deadline_ms = 1000, .core = 3}, consumer, TaskRole::kLiveOnly);
  graph.connect(producer.numbers, consumer.numbers, {.capacity = 64, .lag = 20ms});
  EXPECT_EQ(graph.to_text(),
            "task           rate Hz  priority  core  soft ms  hard ms  deadline ms  role\n"
            "reader             500        80     -      0.2        1            2  input\n"
            "writer              20         -     3        -        -         1000  live only\n"
            "\n"
            "from                 to                   capacity   lag ms\n"
            "reader.numbers       writer.numbers             64       20\n");
}

using TaskGraphDeathTest = TaskGraphTest;

TEST_F(TaskGraphDeathTest, APortOfATaskThatWasNotAddedIsAMistake) {
  graph.add({.name = "from"}, producer);
  EXPECT_DEATH(graph.connect(producer.numbers, consumer.numbers, {}), "");
}

TEST_F(TaskGraphDeathTest, APortHasOneChannel) {
  graph.add({.name = "from"}, producer);
  graph.add({.name = "to"}, consumer);
  graph.connect(producer.numbers, consumer.numbers, {});
  EXPECT_DEATH(graph.connect(producer.numbers, consumer.numbers, {}), "");
}

}  // namespace
}  // namespace cairn::scheduler
