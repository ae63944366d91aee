// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/json/budgets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cairn::report {
namespace {

using ::testing::HasSubstr;

const nlohmann::ordered_json kReport = {{"tasks", {{"safety", {{"missed", 3}, {"response_p99_ms", 0.4}}}}},
                                        {"memory", {{"peak_rss_mb", 100.0}}},
                                        {"robot", "husky"}};

TEST(Budgets, EveryLimitIsComparedAndTheTableSaysWhichWasExceeded) {
  const auto limits = parse_budgets(
      "tasks:\n  safety:\n    missed: 2\n    response_p99_ms: 0.4\nmemory:\n  peak_rss_mb: 512\n", "b.yaml");
  ASSERT_TRUE(limits) << to_string(limits.error());
  const auto verdicts = check_budgets(*limits, kReport);
  ASSERT_TRUE(verdicts) << to_string(verdicts.error());
  ASSERT_EQ(verdicts->size(), 3U);
  EXPECT_FALSE((*verdicts)[0].kept());
  EXPECT_TRUE((*verdicts)[1].kept()) << "at most";
  EXPECT_FALSE(all_kept(*verdicts));
  EXPECT_THAT(to_table(*verdicts), ::testing::ContainsRegex("tasks.safety.missed +2 +3  EXCEEDED"));
}

TEST(Budgets, ALimitThatCannotBeCheckedIsAnErrorAndNotKept) {
  const auto limits = parse_budgets("tasks:\n  safty:\n    missed: 2\nrobot: 3\nmemory: {peak_rss_mb: 1}\n", "b.yaml");
  ASSERT_TRUE(limits);
  const auto verdicts = check_budgets(*limits, kReport);
  ASSERT_FALSE(verdicts);
  EXPECT_THAT(verdicts.error().detail, HasSubstr("line 3: tasks.safty.missed"));
  EXPECT_THAT(verdicts.error().detail, HasSubstr("line 4: robot"));
}

TEST(Budgets, AllFaultsOfAFileAreNamedAtOnce) {
  const auto bad = parse_budgets("tasks:\n  safety: fast\nmemory: [1]\nx: .inf\nx: 2\ny: 1\ny: 2\n", "b.yaml");
  ASSERT_FALSE(bad);
  for (const char* fault : {"b.yaml:2: tasks.safety: a limit must be a number", "b.yaml:3: memory: must be a mapping",
                            "b.yaml:4: x: a limit", "b.yaml:7: y: is given twice"})
    EXPECT_THAT(bad.error().detail, HasSubstr(fault));
  EXPECT_FALSE(parse_budgets("", "b.yaml"));
  EXPECT_FALSE(parse_budgets("a: [", "b.yaml"));
}

}  // namespace
}  // namespace cairn::report
