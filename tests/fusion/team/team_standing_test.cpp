// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "fusion/team/team.hpp"
#include "tests/fusion/team/two_teams.hpp"

namespace cairn::team {
namespace {

using fleet::say_walls;
using fleet::talk;
using fleet::team_member;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

class TeamStanding : public testing::Test {
 protected:
  Time now_{std::chrono::seconds(100)};
  Team a_{team_member(1), peers::Epoch{1} << 32U};
};

TEST_F(TeamStanding, OfALiarsThousandClaimsOnlySomeAreWeighed) {
  peers::ExchangeConfig config;
  config.voxel_um = 200'000;
  config.bytes_per_second = 1'000'000;
  peers::Exchange liar(2, "liar", peers::Epoch{1} << 32U, config);
  const UncertainPose here{SE3(), Matrix6::Identity()};
  for (std::uint16_t i = 0; i < 1000; ++i)
    liar.say(peers::ItemId::edge(i), encode(peers::Edge{0, 1, a_.exchange().epoch(), 0, here, 0.9F}));
  for (int i = 0; i < 100; ++i, now_ += milliseconds(100)) {
    std::vector<peers::Outgoing> from_a, from_liar;
    a_.step(now_, from_a);
    liar.send(now_, from_liar);
    for (const auto& datagram : from_a) ASSERT_TRUE(liar.receive(datagram.bytes, now_));
    for (const auto& datagram : from_liar) ASSERT_TRUE(a_.receive(datagram.bytes, now_));
  }
  EXPECT_GT(a_.exchange().layers().at(2).holding.items().size(), 900U);
  EXPECT_EQ(a_.claims().size(), 256U);
}

TEST(PeerStates, EachHasANameOfItsOwnThatIsReadBack) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kPeerStates; ++i) {
    const auto state = static_cast<PeerState>(i);
    EXPECT_FALSE(to_string(state).empty());
    EXPECT_EQ(peer_state_from(to_string(state)), state);
    names.insert(to_string(state));
  }
  EXPECT_EQ(names.size(), kPeerStates);
  EXPECT_FALSE(peer_state_from(""));
  EXPECT_FALSE(peer_state_from("no link"));
}

TEST_F(TeamStanding, NobodyWasHeardOf) {
  const PeerStanding standing = a_.standing(2, now_);
  EXPECT_EQ(standing.state, PeerState::kNeverHeard);
  EXPECT_EQ(standing.reason, "never heard of");
  EXPECT_FALSE(standing.merged());
}

TEST_F(TeamStanding, GoesFromNoMapToTooLittleToBeingComparedAndToNoLink) {
  Team b(team_member(2), peers::Epoch{1} << 32U);
  talk(a_, b, now_, milliseconds(1500));
  EXPECT_EQ(a_.standing(2, now_).reason, "it has said nothing of its map yet");
  EXPECT_EQ(a_.standing(2, now_).state, PeerState::kNoMap);
  say_walls(a_, 100, now_);
  say_walls(b, 3, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  EXPECT_EQ(a_.standing(2, now_).reason, "too little mapped: 100 and 3 tiles with walls, 60 needed");
  EXPECT_EQ(a_.standing(2, now_).state, PeerState::kTooLittleMapped);
  say_walls(b, 100, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  ASSERT_TRUE(a_.next_match(now_));
  EXPECT_EQ(a_.standing(2, now_).reason, "being compared");
  EXPECT_EQ(a_.standing(2, now_).state, PeerState::kBeingCompared);
  EXPECT_THAT(b.standing(1, now_).reason, HasSubstr("it compares"));
  EXPECT_EQ(b.standing(1, now_).state, PeerState::kPeerCompares);
  EXPECT_EQ(a_.standing(2, now_ + std::chrono::seconds(12)).reason, "no link: not heard for 12 s");
  EXPECT_EQ(a_.standing(2, now_ + std::chrono::seconds(12)).state, PeerState::kNoLink);
}

TEST_F(TeamStanding, MapsOfOtherVoxelsAreNotExchanged) {
  Team b(team_member(2, 0.1), peers::Epoch{1} << 32U);
  say_walls(b, 100, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  EXPECT_EQ(a_.standing(2, now_).reason, "its map has voxels of 0.100 m, this one's 0.200 m");
  EXPECT_EQ(a_.standing(2, now_).state, PeerState::kOtherResolution);
  EXPECT_TRUE(!a_.exchange().layers().contains(2) || a_.exchange().layers().at(2).holding.items().empty());
}

TEST_F(TeamStanding, AnotherFormatIsNamed) {
  Team b(team_member(2), peers::Epoch{1} << 32U);
  std::vector<peers::Outgoing> out;
  b.step(now_, out);
  ASSERT_FALSE(out.empty());
  out[0].bytes[0] = std::byte{99};
  EXPECT_FALSE(a_.receive(out[0].bytes, now_));
  EXPECT_EQ(a_.standing(2, now_).reason, "it speaks another version of the peers' format");
  EXPECT_EQ(a_.standing(2, now_).state, PeerState::kOtherVersion);
}

TEST_F(TeamStanding, ABeginningVoidsWhatWasSaid) {
  Team b(team_member(2), peers::Epoch{1} << 32U);
  say_walls(a_, 100, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  EXPECT_EQ(b.exchange().layers().at(1).holding.items().size(), 100U);
  a_.begin(peers::Epoch{2} << 32U);
  say_walls(a_, 3, now_);
  talk(a_, b, now_, std::chrono::seconds(5));
  EXPECT_EQ(b.exchange().layers().at(1).holding.items().size(), 3U);
}

}  // namespace
}  // namespace cairn::team
