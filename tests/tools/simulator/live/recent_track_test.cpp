// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/recent_track.hpp"

#include <gtest/gtest.h>

namespace cairn::simulator {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin = Time(7s);

Vector6 at(double x) { return (Vector6() << x, 0, 0, 0, 0, 0.01 * x).finished(); }

TEST(RecentTrack, GoesStraightBetweenItsPoses) {
  RecentTrack track(kBegin, at(0));
  EXPECT_EQ(track.end(), kBegin);
  track.append(at(1));
  track.append(at(3));
  EXPECT_EQ(track.end(), kBegin + 2 * RecentTrack::kStep);
  EXPECT_EQ(track.T_world_base(kBegin).translation().x(), 0);
  EXPECT_NEAR(track.T_world_base(kBegin + 500us).translation().x(), 0.5, 1e-12);
  EXPECT_NEAR(track.T_world_base(kBegin + 1ms).translation().x(), 1, 1e-12);
  EXPECT_NEAR(track.T_world_base(kBegin + 1250us).translation().x(), 1.5, 1e-12);
  EXPECT_NEAR(track.T_world_base(kBegin + 1250us).xyz_rpy()[5], 0.015, 1e-12);
}

TEST(RecentTrack, RestsBeforeAndAfterWhatItKnows) {
  RecentTrack track(kBegin, at(0));
  track.append(at(1));
  EXPECT_EQ(track.T_world_base(kBegin - 1s).translation().x(), 0);
  EXPECT_EQ(track.T_world_base(kBegin + 1s).translation().x(), 1);
}

TEST(RecentTrack, KeepsTheLastSecond) {
  RecentTrack track(kBegin, at(0));
  constexpr int kSteps = 5000;
  for (int i = 1; i <= kSteps; ++i) track.append(at(i));
  const auto x_at = [&](int step) { return track.T_world_base(kBegin + step * RecentTrack::kStep).translation().x(); };
  for (int i = kSteps - static_cast<int>(RecentTrack::kKept) + 1; i <= kSteps; ++i) ASSERT_EQ(x_at(i), i);
  EXPECT_EQ(x_at(10), kSteps - static_cast<int>(RecentTrack::kKept) + 1) << "the oldest that is kept";
}

}  // namespace
}  // namespace cairn::simulator
