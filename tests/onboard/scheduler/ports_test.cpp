// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/ports.hpp"

#include <gtest/gtest.h>

namespace cairn::scheduler {
namespace {

struct ManyPorts final : Task {
  void tick(Tick& /*tick*/) override {}
  InputPort<int> numbers{*this, "numbers"};
  const std::size_t packets = take_slots(3), level = take_slots();
  OutputPort<int> results{*this, "results"};
  InputPort<double> late{*this, "late"};
};

TEST(Ports, AreNumberedInTheOrderOfTheirDeclaration) {
  const ManyPorts task;
  EXPECT_EQ(task.numbers.slot(), 0U);
  EXPECT_EQ(task.packets, 1U) << "three in a row";
  EXPECT_EQ(task.level, 4U);
  EXPECT_EQ(task.results.slot(), 5U);
  EXPECT_EQ(task.late.slot(), 6U);
  EXPECT_EQ(&task.late.task(), &task);
}

TEST(PortsDeathTest, ATaskWithMoreSlotsThanARecordHasIsAMistake) {
  ManyPorts task;
  EXPECT_EQ(task.take_slots(TickRecord::kSlots - 7), 7U);
  EXPECT_DEATH((void)task.take_slots(), "");
}

TEST(Ports, WithoutAChannelNothingComesInAndNothingGoesOut) {
  ManyPorts task;
  TickRecord record;
  Tick tick(Regime::kLive, Time{}, record);
  EXPECT_EQ(task.numbers.take(tick), nullptr);
  task.numbers.give_back(tick);
  EXPECT_EQ(task.numbers.size(), 0U);
  EXPECT_EQ(task.numbers.channel(), nullptr);
  EXPECT_FALSE(task.results.connected());
  EXPECT_EQ(task.results.back(tick), nullptr);
  EXPECT_TRUE(record.idle());
}

}  // namespace
}  // namespace cairn::scheduler
