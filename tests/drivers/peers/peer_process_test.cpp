// SPDX-License-Identifier: Apache-2.0
// Two peer processes over Cyclone DDS on loopback; the test is the core of both.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <string>

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

}  // namespace
}  // namespace cairn::peers
