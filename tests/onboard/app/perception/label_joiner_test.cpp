// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/label_joiner.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace cairn::app {
namespace {

/// A robot without a camera that has mapped scans from t = 10 s to 12.9 s.
class LabelJoining : public ::testing::Test {
 protected:
  LabelJoining() {
    for (int i = 0; i < 30; ++i) {
      LocatedScan scan;
      scan.stamp = Time{from_seconds(10 + 0.1 * i)};
      scan.points_base = {{5, 0, 0}};
      EXPECT_TRUE(robot_.extend_map(scan));
    }
  }
  void picture_at(double t, double now) {
    LabelImage labels;
    labels.stamp = Time{from_seconds(t)};
    joiner_.add(labels);
    scheduler::TickRecord record{};
    const scheduler::Tick tick(scheduler::Regime::kVirtual, Time{from_seconds(now)}, record);
    joiner_.join(tick);
  }
  bool has_event(const std::string& what) const {
    return std::ranges::any_of(monitor_.events(),
                               [&](const Event& e) { return e.what.find(what) != std::string::npos; });
  }

  Monitor monitor_;
  Workers one_{1}, another_{1};
  Robot robot_{{}, one_, another_, monitor_};
  LabelJoiner joiner_{robot_, monitor_};
};

TEST_F(LabelJoining, APictureBeforeTheMapIsCountedAndNoEvent) {
  picture_at(9.9, 10.2);
  EXPECT_EQ(joiner_.figures().apart.get(), 1U);
  EXPECT_TRUE(monitor_.events().empty());
}

TEST_F(LabelJoining, APictureOfTheFutureIsAnEventOfItsOwnAndIsNotWaitedFor) {
  picture_at(15.0, 13.0);
  EXPECT_EQ(joiner_.figures().apart.get(), 1U);
  EXPECT_TRUE(has_event("in the future"));
}

}  // namespace
}  // namespace cairn::app
