// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/schedule_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace cairn::scheduler {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

TickRecord record(std::uint64_t index, std::uint32_t skipped, std::array<std::int32_t, TickRecord::kSlots> slots) {
  return {index, skipped, slots};
}

TEST(ScheduleLog, ReadsBackWhatWasWritten) {
  const support::TemporaryFolder folder;
  ScheduleLog log;
  log.tasks.push_back({"safety", {Time{5s}, 1ms}, {record(3, 0, {1}), record(9, 2, {})}, 12});
  log.tasks.push_back({"receive", {Time{5s + 2ms}, 10ms}, {record(0, 0, {75, 0, -3})}, 1});
  ScheduleLogWriter writer(folder / "schedule.log");
  for (std::size_t i = 0; i < 2; ++i) writer.task(i, log.tasks[i].name, log.tasks[i].releases);
  writer.tick(1, log.tasks[1].ticks[0]);
  for (const TickRecord& t : log.tasks[0].ticks) writer.tick(0, t);
  for (std::size_t i = 0; i < 2; ++i) writer.end(i, log.tasks[i].end);
  ASSERT_TRUE(writer.close());

  const auto read = load_schedule_log(folder / "schedule.log");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->tasks, log.tasks);
  EXPECT_EQ(read->find("receive"), &read->tasks[1]);
  EXPECT_EQ(read->find("mapping"), nullptr);
}

TEST(ScheduleLog, ALogWithoutEndSaysSo) {
  const auto cut = parse_schedule_log("cairn-schedule 1\ntask 0 a 0 10\n0 1 0 5\n");
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, Errc::kTruncated);
}

TEST(ScheduleLog, WhatCannotBeIsRefusedWithItsLine) {
  const std::string head = "cairn-schedule 1\ntask 0 a 0 10\n";
  for (const char* line :
       {"1 0 0", "0 1", "0 -1 0", "0 5 6", "0 5 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21",
        "task 1 b 0 0", "task 3 b 0 5", "task 1 b -1 5", "end 1 4", "0 99999999999999999999 0", "0 5 0 x",
        "0 1000000000000000000 0", "end 0 18446744073709551615"}) {
    const auto bad = parse_schedule_log(head + line + "\n");
    ASSERT_FALSE(bad) << line;
    EXPECT_EQ(bad.error().code, Errc::kMalformed) << line;
    EXPECT_THAT(to_string(bad.error()), HasSubstr("line 3"));
  }
  EXPECT_FALSE(parse_schedule_log(head + "0 4 0 1\n0 4 0 1\nend 0 9\n")) << "one tick, two lines";
  EXPECT_FALSE(parse_schedule_log(head + "0 4 0 1\nend 0 4\n")) << "the end lies before the last tick";
  EXPECT_FALSE(parse_schedule_log(head + "end 0 4\nend 0 5\n"));
  const auto endless = parse_schedule_log(head + "end 0 500000001\n");
  EXPECT_EQ(endless.error().code, Errc::kLimit) << "a replay would go through each idle tick";
  EXPECT_FALSE(parse_schedule_log("something else\n"));
  EXPECT_FALSE(parse_schedule_log(""));
}

}  // namespace
}  // namespace cairn::scheduler
