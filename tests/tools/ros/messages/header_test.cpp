// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/header.hpp"

#include <gtest/gtest.h>

namespace cairn::ros {
namespace {

constexpr Duration kUtc = std::chrono::seconds(1'700'000'000);

Time at(std::int64_t ns) { return Time{Duration{ns}}; }

TEST(RosHeader, StampIsUtcInSecondsAndNanoseconds) {
  const Stamp stamp = stamp_of(at(12'345'678'901), kUtc);
  EXPECT_EQ(stamp.sec, 1'700'000'012);
  EXPECT_EQ(stamp.nanosec, 345'678'901U);
  EXPECT_EQ(utc_of(stamp), kUtc + Duration{12'345'678'901});
}

TEST(RosHeader, StampsThatRosCannotWriteAreTheNearestOnes) {
  EXPECT_EQ(stamp_of(at(-1), Duration{}).sec, 0);
  EXPECT_EQ(stamp_of(Time::min(), -kUtc).sec, 0);
  const Stamp last = stamp_of(Time::max(), kUtc);
  EXPECT_EQ(last.sec, 2'147'483'647);
  EXPECT_EQ(last.nanosec, 999'999'999U);
}

TEST(RosHeader, TextsAndSequencesAreOfTheArena) {
  Arena arena;
  const Header header = header_of(at(5), kUtc, "odom", arena);
  EXPECT_STREQ(header.frame_id, "odom");
  TfMessage message{};
  const auto transforms = arena.sequence(message.transforms, 3);
  EXPECT_EQ(message.transforms._length, 3U);
  EXPECT_EQ(message.transforms._buffer, transforms.data());
  EXPECT_EQ(transforms[2].child_frame_id, nullptr);
  EXPECT_EQ(arena.sequence(message.transforms, 0).size(), 0U);
}

TEST(UtcOffset, FollowsStepsOfTheClockAndNotItsNoise) {
  using std::chrono::milliseconds;
  UtcOffset offset;
  offset.greeted(kUtc, milliseconds(7));
  offset.follow(milliseconds(9));
  EXPECT_EQ(offset.value(), kUtc);
  offset.follow(milliseconds(3607));
  EXPECT_EQ(offset.value(), kUtc + milliseconds(3600));
  offset.follow(milliseconds(3606));
  EXPECT_EQ(offset.value(), kUtc + milliseconds(3600));
}

TEST(RosFrames, PrefixIsOfAllButTheTeams) {
  const Frames frames("husky/");
  EXPECT_EQ(frames.odom, "husky/odom");
  EXPECT_EQ(frames.base_link, "husky/base_link");
  EXPECT_EQ(frames.team, "team");
}

}  // namespace
}  // namespace cairn::ros
