// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fusion/team.hpp"

namespace cairn {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

TeamConfig config(peers::RobotId id, double resolution_m = 0.2) {
  TeamConfig config;
  config.id = id;
  config.name = "robot_" + std::to_string(id);
  config.resolution_m = resolution_m;
  return config;
}

TileState wall() {
  TileState state;
  for (unsigned i = 0; i < 64; ++i) state.set(i % 8, 3, i / 8, 2);
  return state;
}

void say(Team& team, unsigned tiles, Time now) {
  for (unsigned i = 0; i < tiles; ++i)
    team.observe(TileKey::of_voxel(static_cast<std::uint16_t>(32768 + 8 * i), 32768, 32768), wall(), now);
}

/// Both talk for so long, ten times a second, over a link that loses nothing.
void talk(Team& a, Team& b, Time& now, Duration length) {
  for (const Time end = now + length; now < end; now += milliseconds(100)) {
    std::vector<peers::Outgoing> from_a, from_b;
    a.step(now, from_a);
    b.step(now, from_b);
    for (const auto& datagram : from_a) (void)b.receive(datagram.bytes, now);
    for (const auto& datagram : from_b) (void)a.receive(datagram.bytes, now);
  }
}

class TeamStanding : public testing::Test {
 protected:
  Time now_{std::chrono::seconds(100)};
  Team a_{config(1), peers::Epoch{1} << 32U};
};

TEST_F(TeamStanding, NobodyWasHeardOf) { EXPECT_EQ(a_.standing(2, now_).reason, "never heard of"); }

TEST_F(TeamStanding, GoesFromNoMapToTooLittleToBeingComparedAndToNoLink) {
  Team b(config(2), peers::Epoch{1} << 32U);
  talk(a_, b, now_, milliseconds(1500));
  EXPECT_EQ(a_.standing(2, now_).reason, "it has said nothing of its map yet");
  say(a_, 100, now_);
  say(b, 3, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  EXPECT_EQ(a_.standing(2, now_).reason, "too little mapped: 100 and 3 tiles with walls, 60 needed");
  say(b, 100, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  ASSERT_TRUE(a_.next_match(now_));
  EXPECT_EQ(a_.standing(2, now_).reason, "being compared");
  EXPECT_THAT(b.standing(1, now_).reason, HasSubstr("it compares"));
  EXPECT_EQ(a_.standing(2, now_ + std::chrono::seconds(12)).reason, "no link: not heard for 12 s");
}

TEST_F(TeamStanding, MapsOfOtherVoxelsAreNotExchanged) {
  Team b(config(2, 0.1), peers::Epoch{1} << 32U);
  say(b, 100, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  EXPECT_EQ(a_.standing(2, now_).reason, "its map has voxels of 0.100 m, this one's 0.200 m");
  EXPECT_TRUE(!a_.exchange().layers().contains(2) || a_.exchange().layers().at(2).holding.items().empty());
}

TEST_F(TeamStanding, AnotherFormatIsNamed) {
  Team b(config(2), peers::Epoch{1} << 32U);
  std::vector<peers::Outgoing> out;
  b.step(now_, out);
  ASSERT_FALSE(out.empty());
  out[0].bytes[0] = std::byte{99};
  EXPECT_FALSE(a_.receive(out[0].bytes, now_));
  EXPECT_EQ(a_.standing(2, now_).reason, "it speaks another version of the peers' format");
}

TEST_F(TeamStanding, ABeginningVoidsWhatWasSaid) {
  Team b(config(2), peers::Epoch{1} << 32U);
  say(a_, 100, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  EXPECT_EQ(b.exchange().layers().at(1).holding.items().size(), 100U);
  a_.begin(peers::Epoch{2} << 32U);
  say(a_, 3, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  EXPECT_EQ(b.exchange().layers().at(1).holding.items().size(), 3U);
}

}  // namespace
}  // namespace cairn
