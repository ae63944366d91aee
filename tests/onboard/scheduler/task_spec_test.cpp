// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/task_spec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace cairn::scheduler {
namespace {

using ::testing::HasSubstr;

TaskSpec task(const char* name, double rate_hz, double soft_ms, int core = -1) {
  TaskSpec t;
  t.name = name;
  t.rate_hz = rate_hz;
  t.soft_ms = soft_ms;
  t.core = core;
  return t;
}

TEST(TaskSpec, SeventyPercentOfACoreMayBePromisedAndNotMore) {
  EXPECT_TRUE(validate(std::vector{task("a", 100, 3, 0), task("b", 10, 40, 0)}, 2));
  const auto refused = validate(std::vector{task("a", 100, 3, 0), task("b", 10, 41, 0)}, 2);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(refused.error().detail, HasSubstr("core 0: 71.0 % of it are planned, and 70 % may be"));
  EXPECT_THAT(refused.error().detail, HasSubstr("b                 10.0"));
}

TEST(TaskSpec, UnboundTasksShareAllCores) {
  EXPECT_TRUE(validate(std::vector{task("a", 10, 70), task("b", 10, 70)}, 2));
  const auto refused = validate(std::vector{task("a", 10, 70), task("b", 10, 75)}, 2);
  EXPECT_THAT(refused.error().detail,
              HasSubstr("all 2 cores: 145.0 % of one are planned, and 140 % may be, 70 % of each\n"
                        "lower soft_ms, busy_hz or rate_hz of the largest share, or use more cores\n"));
  EXPECT_FALSE(validate(std::vector{task("a", 10, 70), task("b", 10, 70)}, 1));
  EXPECT_FALSE(validate(std::vector{task("a", 10, 70, 0), task("b", 10, 71)}, 2));
}

/// A network may use what geometry leaves, and still not all of it.
TEST(TaskSpec, WeakTasksMayUseWhatOthersLeave) {
  TaskSpec weak = task("weak", 5, 100);
  weak.nice = 5;
  EXPECT_TRUE(validate(std::vector{task("a", 10, 70), task("b", 10, 70), weak}, 2)) << "1.9 of 2 cores";
  weak.soft_ms = 102;
  const auto refused = validate(std::vector{task("a", 10, 70), task("b", 10, 70), weak}, 2);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().detail, HasSubstr("all 2 cores with weak tasks: 191.0 %"));
  weak.nice = 0;
  weak.soft_ms = 1;
  EXPECT_FALSE(validate(std::vector{task("a", 10, 70), task("b", 10, 70), weak}, 2));
}

TEST(TaskSpec, OnlyReleasesWithWorkAreCounted) {
  TaskSpec t = task("odometry", 100, 40);
  EXPECT_FALSE(validate(std::vector{t}, 2));
  t.busy_hz = 10;
  EXPECT_DOUBLE_EQ(t.utilisation(), 0.4);
  EXPECT_TRUE(validate(std::vector{t}, 2));
}

TEST(TaskSpec, AllFaultsAreNamedAtOnce) {
  TaskSpec a = task("a", 100, 3, 7), b = task("b", 100, 4);
  b.hard_ms = 2;
  TaskSpec c = task("c", 100, 1);
  c.hard_ms = 11;
  const auto refused = validate(std::vector{a, b, c}, 2);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().detail, HasSubstr("a: core 7, but this machine has 2"));
  EXPECT_THAT(refused.error().detail, HasSubstr("b: soft_ms is above hard_ms"));
  EXPECT_THAT(refused.error().detail, HasSubstr("c: hard_ms is above the deadline"));
}

}  // namespace
}  // namespace cairn::scheduler
