// SPDX-License-Identifier: Apache-2.0
// Two peer processes over Cyclone DDS on loopback; the test is the core of both.
#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include "drivers/peers/domain_claim.hpp"
#include "hal/files/file.hpp"
#include "tests/drivers/peers/peer.hpp"
#include "tests/drivers/peers/udp_malformed.hpp"

namespace cairn::peer_link {
namespace {

class PeerProcess : public testing::Test {
 protected:
  std::string domain() const { return std::to_string(claim_.domain()); }

  support::TemporaryFolder folder;

 private:
  DomainClaim claim_ = DomainClaim::make().value();
};

TEST_F(PeerProcess, CarriesDatagramsAndComesBackAfterBeingKilled) {
  Peer one(1, folder.path(), domain()), two(2, folder.path(), domain());
  EXPECT_TRUE(arrives(one, two, 0, datagram(1, 40)));
  EXPECT_TRUE(arrives(two, one, 0, datagram(2, 1200)));
  EXPECT_TRUE(arrives(one, two, 2, datagram(3, 1100)));
  two.stop(SIGKILL);
  two.start();
  EXPECT_TRUE(arrives(one, two, 2, datagram(3, 900)));
  EXPECT_TRUE(arrives(two, one, 1, datagram(3, 901)));
  EXPECT_EQ(one.stop(SIGTERM), 0);
}

TEST_F(PeerProcess, WhatARobotSaysToAllDoesNotComeBackToIt) {
  Peer one(1, folder.path(), domain()), two(2, folder.path(), domain());
  EXPECT_TRUE(arrives(one, two, 0, datagram(1, 40)));
  EXPECT_TRUE(arrives(two, one, 0, datagram(1, 50)));
  EXPECT_TRUE(arrives(one, two, 0, datagram(2, 60)));
  std::vector<std::vector<std::byte>> heard;
  EXPECT_TRUE(arrives(two, one, 0, datagram(2, 70), &heard)) << "what was to come from itself has come before that";
  for (const auto& bytes : heard) EXPECT_EQ(bytes.size(), 50U) << "its own";
}

/// Cyclone DDS would wait for a thread that waits for the cap.
TEST_F(PeerProcess, EndsWhenItIsToldToThoughItsCapIsTiny) {
  Peer one(1, folder.path(), domain(), "60");
  while (!one.link.join()) (void)one.received(10);
  EXPECT_EQ(one.stop(SIGTERM), 0);
}

TEST(PeerProcessOptions, ATeammateThatIsNoAddressIsRefused) {
  for (const char* address : {"notanip", "10.0.0", "10.0.0.2:7400", ""}) {
    std::vector<std::string> words{places::program("cairn-peers"), "--robot", "1", "--socket", "s", "--peer", address};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t process = 0;
    ASSERT_EQ(::posix_spawn(&process, arguments[0], nullptr, nullptr, arguments.data(), environ), 0);
    int status = 0;
    ::waitpid(process, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 2) << address;
  }
}

TEST_F(PeerProcess, MalformedPacketsDoNotFillTheLog) {
  const auto log = folder / "log.txt";
  Peer peer(1, folder.path(), domain(), "1000000", log);
  const LiveClock clock;
  const auto said = [&] {
    std::error_code none_yet;
    const auto size = std::filesystem::file_size(log, none_yet);
    return none_yet ? 0 : size;
  };
  const unsigned of_domain = static_cast<unsigned>(std::stoul(domain()));
  for (const Time end = clock.now() + std::chrono::minutes(5); said() == 0 && clock.now() < end;)
    send_malformed(of_domain, 4);
  EXPECT_GT(said(), 0U) << "Cyclone has written its first line";
  send_malformed(of_domain, 40'000);
  peer.stop(SIGTERM);
  EXPECT_LT(said(), 10'000U);
  const auto bytes = read_file(log, 1U << 20U).value();
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_NE(text.find("more lines in a minute like:"), text.npos) << text;
}

}  // namespace
}  // namespace cairn::peer_link
