// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/accuracy.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/report/sample_report.hpp"

namespace cairn::report {
namespace {

TEST(Accuracy, WithoutGroundTruthThereIsNone) {
  const Accuracy accuracy = accuracy_of(uneventful());
  EXPECT_FALSE(accuracy.error);
  EXPECT_TRUE(accuracy.why_not.empty());
  EXPECT_TRUE(accuracy.pose_errors.empty());
}

TEST(Accuracy, HasAnErrorForEveryPoseWithTruth) {
  const auto run = sample_run(50);
  const Accuracy accuracy = accuracy_of(run->report);
  ASSERT_TRUE(accuracy.error);
  EXPECT_EQ(accuracy.pose_errors.size(), 50U);
  EXPECT_EQ(accuracy.error->matched, 50U);
}

TEST(Accuracy, SaysWhyATruthCannotBeCompared) {
  auto run = sample_run(10);
  for (StampedPose& p : run->report.ground_truth) p.stamp += from_seconds(1e5);
  const Accuracy accuracy = accuracy_of(run->report);
  EXPECT_FALSE(accuracy.error);
  EXPECT_FALSE(accuracy.why_not.empty());
}

}  // namespace
}  // namespace cairn::report
