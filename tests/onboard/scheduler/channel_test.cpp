// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/channel.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "onboard/scheduler/ports.hpp"

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;

/// The producer's slot is 1 and the consumer's is 0.
struct Producer final : Task {
  void tick(Tick& /*tick*/) override {}
  const std::size_t first = take_slots();
  OutputPort<int> out{*this, "out"};
};
struct Consumer final : Task {
  void tick(Tick& /*tick*/) override {}
  InputPort<int> in{*this, "in"};
};

struct ChannelTest : ::testing::Test {
  ChannelTest() {
    producer.out.connect(channel);
    consumer.in.connect(channel);
  }
  TickRecord& produce(Regime regime, Time release, int count, std::int32_t logged = 0) {
    pushed = {};
    pushed.index = index++;
    pushed.slots[1] = logged;
    Tick tick(regime, release, pushed);
    for (int i = 0; i < count; ++i) {
      ++made;
      if (int* value = producer.out.back(tick)) {
        *value = made;
        producer.out.push(tick);
      }
    }
    return pushed;
  }
  std::vector<int> consume(Regime regime, Time release, std::int32_t logged = 0) {
    taken = {};
    taken.index = index++;
    taken.slots[0] = logged;
    Tick tick(regime, release, taken);
    std::vector<int> values;
    while (const int* value = consumer.in.take(tick)) values.push_back(*value);
    return values;
  }

  Progress produced, consumed;
  Channel<int> channel{{.capacity = 3, .lag = 5ms}, produced, consumed};
  Producer producer;
  Consumer consumer;
  TickRecord pushed, taken;
  std::uint64_t index = 0;
  int made = 0;
};

TEST_F(ChannelTest, InVirtualTimeAValueIsVisibleAfterItsLag) {
  produce(Regime::kVirtual, Time{10ms}, 2);
  EXPECT_TRUE(consume(Regime::kVirtual, Time{15ms} - 1ns).empty());
  EXPECT_EQ(consume(Regime::kVirtual, Time{15ms}), (std::vector{1, 2}));
}

TEST_F(ChannelTest, LiveTakesWhatIsThereAndNotesHowMuch) {
  produce(Regime::kLive, Time{10ms}, 2);
  EXPECT_TRUE(pushed.idle());
  EXPECT_EQ(consume(Regime::kLive, Time{0ms}), (std::vector{1, 2}));
  EXPECT_EQ(taken.slots[0], 2);
}

TEST_F(ChannelTest, WhenFullTheRestOfTheTickIsDroppedAndTheLogRepeatsThat) {
  EXPECT_EQ(produce(Regime::kLive, Time{0ms}, 5).slots[1], 4) << "three were accepted";
  EXPECT_EQ(channel.fill().dropped, 2U);
  EXPECT_EQ(produce(Regime::kLive, Time{0ms}, 1).slots[1], 1) << "none was";
  EXPECT_EQ(consume(Regime::kLive, Time{0ms}), (std::vector{1, 2, 3}));

  produce(Regime::kLogged, Time{0ms}, 3, 2);
  EXPECT_EQ(consume(Regime::kLogged, Time{0ms}, 1), (std::vector{7})) << "one was accepted then";
}

TEST_F(ChannelTest, AConsumerOfALogGetsWhatItGotThen) {
  produce(Regime::kLogged, Time{50ms}, 3);
  taken.slots[0] = 2;
  EXPECT_TRUE(consumer.in.holds(taken));
  EXPECT_EQ(consume(Regime::kLogged, Time{0ms}, 2), (std::vector{1, 2})) << "though it was released earlier";
  taken.slots[0] = 2;
  EXPECT_FALSE(consumer.in.holds(taken));
}

}  // namespace
}  // namespace cairn::scheduler
