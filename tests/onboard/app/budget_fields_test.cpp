// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/budget_fields.hpp"

#include <gmock/gmock.h>

#include <string>

#include "tests/support/places.hpp"

namespace cairn::app {
namespace {

using ::testing::HasSubstr;

Result<void> checked(const std::string& yaml) {
  const auto limits = report::parse_budgets(yaml, "b.yaml");
  EXPECT_TRUE(limits) << to_string(limits.error());
  return check_budget_fields(*limits, {});
}

TEST(BudgetFields, ThoseOfTheExamplesAreKnown) {
  for (const char* file : {"husky.yaml", "uav.yaml"}) {
    const auto limits = report::load_budgets(places::source() / "config" / "budgets" / file);
    ASSERT_TRUE(limits) << to_string(limits.error());
    const auto fits = check_budget_fields(*limits, {});
    EXPECT_TRUE(fits) << to_string(fits.error());
  }
}

TEST(BudgetFields, AMisspeltNameIsFoundWithoutARun) {
  for (const char* wrong : {"stages: {odometri: {cpu_p50_ms: 1}}", "stages: {odometry: {cpu_p5_ms: 1}}",
                            "tasks: {safty: {missed: 0}}", "losses: {lider: {kernel_drops: 0}}",
                            "memory: {peak_rss: 1}", "stage: {odometry: {cpu_p50_ms: 1}}", "robot: 1"})
    EXPECT_FALSE(checked(wrong)) << wrong;
  const auto fault = checked("stages:\n  odometri: {cpu_p50_ms: 1}");
  EXPECT_THAT(fault.error().detail, HasSubstr("b.yaml:2: stages.odometri.cpu_p50_ms: report.json has no odometri"));
}

TEST(BudgetFields, WhatOnlyTheRunKnowsIsLeftToIt) {
  for (const char* fine : {"losses: {lidar: {kernel_drops: 0}}", "ground_truth: {ate_rmse_m: 0.1}",
                           "labels: {latency_p99_ms: 400}", "stages: {people: {p99_ms: 5}}", "map: {bytes: 1}",
                           "tasks: {reference: {missed: 0}, team: {missed: 0}}", "distance_m: 3"}) {
    const auto fits = checked(fine);
    EXPECT_TRUE(fits) << to_string(fits.error());
  }
}

}  // namespace
}  // namespace cairn::app
