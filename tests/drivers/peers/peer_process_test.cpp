// SPDX-License-Identifier: Apache-2.0
// Two peer processes over Cyclone DDS on loopback; the test is the core of both.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "tests/drivers/peers/peer.hpp"

namespace cairn::peers {
namespace {

std::string own_domain() { return std::to_string(10 + ::getpid() % 200); }

TEST(PeerProcess, CarriesDatagramsAndComesBackAfterBeingKilled) {
  const support::TemporaryFolder folder;
  Peer one(1, folder.path(), own_domain()), two(2, folder.path(), own_domain());
  EXPECT_TRUE(arrives(one, two, 0, datagram(1, 40)));
  EXPECT_TRUE(arrives(two, one, 0, datagram(2, 1200)));
  EXPECT_TRUE(arrives(one, two, 2, datagram(3, 1100)));
  two.stop(SIGKILL);
  two.start();
  EXPECT_TRUE(arrives(one, two, 2, datagram(3, 900)));
  EXPECT_TRUE(arrives(two, one, 1, datagram(3, 901)));
  EXPECT_EQ(one.stop(SIGTERM), 0);
}

TEST(PeerProcess, WhatARobotSaysToAllDoesNotComeBackToIt) {
  const support::TemporaryFolder folder;
  Peer one(1, folder.path(), own_domain()), two(2, folder.path(), own_domain());
  EXPECT_TRUE(arrives(one, two, 0, datagram(1, 40)));
  EXPECT_TRUE(arrives(two, one, 0, datagram(1, 50)));  // and what was to come from itself had come before that
  one.link.send({LinkFrame::Kind::kSend, 0, datagram(2, 60)});
  std::vector<std::vector<std::byte>> heard;
  for (int i = 0; i < 20; ++i)
    for (auto& bytes : one.received()) heard.push_back(std::move(bytes));
  for (const auto& bytes : heard) EXPECT_EQ(bytes.size(), 50U) << "its own";
}

}  // namespace
}  // namespace cairn::peers
