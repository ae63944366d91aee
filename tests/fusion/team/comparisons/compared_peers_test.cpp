// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/compared_peers.hpp"

#include <gtest/gtest.h>

namespace cairn::team {
namespace {

MatchJob job_about(peers::RobotId peer, peers::Epoch own_epoch, peers::Epoch peer_epoch) {
  return {.peer = peer, .own_epoch = own_epoch, .peer_epoch = peer_epoch};
}

TEST(ComparedPeers, APeersEntryStaysWhileNoneBeginsAnew) {
  ComparedPeers peers{MatchWorthConfig{}};
  EXPECT_EQ(peers.find(2), nullptr);
  ComparedPeer& two = peers.at(2, 10, 20);
  ASSERT_TRUE(two.match);
  two.found = true;
  EXPECT_TRUE(peers.at(2, 10, 20).found);
  EXPECT_EQ(peers.find(2), &two);
}

TEST(ComparedPeers, ABeginningOfEitherEmptiesTheEntryButForItsIndex) {
  ComparedPeers peers{MatchWorthConfig{}};
  (void)peers.at(3, 10, 30);
  for (const auto& [own, peer] : {std::pair{10U, 21U}, {11U, 21U}}) {
    ComparedPeer& two = peers.at(2, 10, 20);
    two.found = true;
    two.match.reset();  // a job has it
    (void)two.edge.update(peers::Edge{.other = 2, .T_own_other = {}, .probability = 0.9F});
    const std::uint16_t index = two.edge.index();
    const ComparedPeer& anew = peers.at(2, own, peer);
    EXPECT_FALSE(anew.found);
    EXPECT_TRUE(anew.match);
    EXPECT_FALSE(anew.edge.stands());
    EXPECT_EQ(anew.edge.index(), index);
  }
  EXPECT_NE(peers.find(2)->edge.index(), peers.find(3)->edge.index());
}

TEST(ComparedPeers, AJobIsAboutNobodyAfterABeginning) {
  ComparedPeers peers{MatchWorthConfig{}};
  ComparedPeer& two = peers.at(2, 10, 20);
  EXPECT_EQ(peers.of(job_about(2, 10, 20), 10), &two);
  EXPECT_EQ(peers.of(job_about(3, 10, 20), 10), nullptr);
  EXPECT_EQ(peers.of(job_about(2, 10, 19), 10), nullptr);
  EXPECT_EQ(peers.of(job_about(2, 9, 20), 10), nullptr);
  EXPECT_EQ(peers.of(job_about(2, 10, 20), 11), nullptr) << "this robot has begun anew since";
}

TEST(ComparedPeers, FirmWordEndsWhatWasFound) {
  ComparedPeers peers{MatchWorthConfig{}};
  ComparedPeer& two = peers.at(2, 10, 20);
  EXPECT_FALSE(peers.heed(2, 0)) << "there is none";
  (void)two.edge.update(peers::Edge{.other = 2, .T_own_other = {}, .probability = 0.9F});
  two.found = true;
  two.match.reset();  // a job has it
  const auto withdrawn = peers.heed(2, 1);
  ASSERT_TRUE(withdrawn);
  EXPECT_EQ(withdrawn->index, two.edge.index());
  EXPECT_EQ(withdrawn->edge.probability, 0);
  EXPECT_FALSE(two.found);
  EXPECT_TRUE(two.match) << "it begins anew";
  EXPECT_EQ(peers.of(job_about(2, 10, 20), 10), nullptr) << "the job is of before";
  EXPECT_FALSE(peers.heed(2, 1)) << "the same again";
}

}  // namespace
}  // namespace cairn::team
