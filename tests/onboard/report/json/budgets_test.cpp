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
  const auto kept = all_kept(*verdicts);
  ASSERT_FALSE(kept);
  EXPECT_EQ(to_string(kept.error()), "budgets were exceeded: 1 of 3 exceeded, 0 not measured");
  EXPECT_THAT(to_table(*verdicts), ::testing::ContainsRegex("tasks.safety.missed +2 +3  EXCEEDED"));
}

TEST(Budgets, WhatTheRunDidNotMeasureWasNotKept) {
  const auto limits = parse_budgets("memory: {peak_rss_mb: 512}\ntasks: {safety: {allocations: 0}}\n", "b.yaml");
  ASSERT_TRUE(limits);
  auto report = kReport;
  report["tasks"]["safety"]["allocations"] = nullptr;
  const auto verdicts = check_budgets(*limits, report);
  ASSERT_TRUE(verdicts) << to_string(verdicts.error());
  EXPECT_FALSE((*verdicts)[1].kept());
  EXPECT_THAT(to_table(*verdicts), ::testing::ContainsRegex("tasks.safety.allocations +0 +-  NOT MEASURED"));
  const auto kept = all_kept(*verdicts);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().code, Errc::kLimit);
  EXPECT_THAT(to_string(kept.error()), HasSubstr("not measured: 0 of 2 exceeded, 1 not measured; "));
  EXPECT_THAT(to_string(kept.error()), HasSubstr("--speed real"));
  report["tasks"]["safety"]["allocations"] = 0;
  EXPECT_TRUE(all_kept(*check_budgets(*limits, report)));
}

TEST(Budgets, ALimitThatCannotBeCheckedIsAnErrorAndNotKept) {
  const auto limits = parse_budgets("tasks:\n  safty:\n    missed: 2\nrobot: 3\nmemory: {peak_rss_mb: 1}\n", "b.yaml");
  ASSERT_TRUE(limits);
  const auto verdicts = check_budgets(*limits, kReport);
  ASSERT_FALSE(verdicts);
  EXPECT_THAT(verdicts.error().detail, HasSubstr("b.yaml:3: tasks.safty.missed"));
  EXPECT_THAT(verdicts.error().detail, HasSubstr("b.yaml:4: robot"));
}

TEST(Budgets, AMisspeltFieldIsFoundBeforeTheRun) {
  const auto limits = parse_budgets(
      "tasks:\n  safty: {missed: 2}\n  safety: {mised: 2, missed: 1}\nrobot: 3\nmemory: {peak_rss_mb: 1}\n"
      "losses: {lidar: {kernel_drops: 0}}\nteam: {held_back: {s: 1}}\ntaks: {safety: {missed: 2}}\n",
      "b.yaml");
  ASSERT_TRUE(limits) << to_string(limits.error());
  auto expected = kReport;
  expected["losses"] = nlohmann::ordered_json::object();
  expected["team"] = nullptr;
  const auto fits = check_fields(*limits, expected);
  ASSERT_FALSE(fits);
  EXPECT_EQ(fits.error().code, Errc::kInvalidConfig);
  EXPECT_EQ(fits.error().detail,
            "\nb.yaml:2: tasks.safty.missed: report.json has no safty there; it has safety\n"
            "b.yaml:3: tasks.safety.mised: report.json has no mised there; it has missed, response_p99_ms\n"
            "b.yaml:4: robot: is no number in report.json\n"
            "b.yaml:8: taks.safety.missed: report.json has no taks there; it has tasks, memory, robot, losses, team\n");
}

TEST(Budgets, AllFaultsOfAFileAreNamedAtOnce) {
  const auto bad = parse_budgets("tasks:\n  safety: fast\nmemory: [1]\nx: .inf\nx: 2\ny: 1\ny: 2\n", "b.yaml");
  ASSERT_FALSE(bad);
  for (const char* fault : {"b.yaml:2: tasks.safety: a limit must be a number", "b.yaml:3: memory: must be a mapping",
                            "b.yaml:4: x: a limit", "b.yaml:7: y: is given twice"})
    EXPECT_THAT(bad.error().detail, HasSubstr(fault));
  EXPECT_FALSE(parse_budgets("", "b.yaml"));
  EXPECT_FALSE(parse_budgets("a: [", "b.yaml"));
  EXPECT_EQ(load_budgets("/nowhere/b.yaml").error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace cairn::report
