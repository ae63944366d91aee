// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/live_server.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <vector>

#include "tests/support/local_socket.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

using support::StreamClient;

class LiveServerTest : public testing::Test {
 protected:
  support::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "live.sock";
};

TEST_F(LiveServerTest, EveryClientGetsEveryLineFromThenOn) {
  auto server = LiveServer::open(path_).value();
  server.publish("nobody listens\n");
  StreamClient a(path_);
  server.publish("one\n");
  StreamClient b(path_);
  server.publish("two\n");
  EXPECT_EQ(a.read(), "one\ntwo\n");
  EXPECT_EQ(b.read(), "two\n");
  EXPECT_EQ(server.clients(), 2U);
}

TEST_F(LiveServerTest, ASlowClientIsDroppedAndTheOthersAreServed) {
  auto server = LiveServer::open(path_).value();
  StreamClient slow(path_), quick(path_);
  const std::string line(60'000, 'x');
  for (int i = 0; i < 100 && server.dropped_clients() == 0; ++i) {
    server.publish(line);
    EXPECT_EQ(quick.read().size(), line.size());
  }
  EXPECT_EQ(server.dropped_clients(), 1U);
  EXPECT_EQ(server.clients(), 1U);
}

TEST_F(LiveServerTest, ClientsThatGoCostNothing) {
  auto server = LiveServer::open(path_).value();
  for (int i = 0; i < 1000; ++i) {
    { const StreamClient gone(path_); }
    server.publish("line\n");
  }
  server.publish("line\n");
  server.publish("line\n");
  EXPECT_LE(server.clients(), 1U);
}

TEST_F(LiveServerTest, MoreReadersThanAllowedAreTurnedAway) {
  auto server = LiveServer::open(path_).value();
  std::vector<std::unique_ptr<StreamClient>> clients;
  for (std::size_t i = 0; i < LiveServer::kMaxClients + 4; ++i) {
    clients.push_back(std::make_unique<StreamClient>(path_));
    server.publish("line\n");
    for (std::size_t k = 0; k < std::min(clients.size(), LiveServer::kMaxClients); ++k)
      EXPECT_EQ(clients[k]->read(), "line\n") << k << " of " << clients.size();
  }
  EXPECT_EQ(server.clients(), LiveServer::kMaxClients);
  EXPECT_EQ(server.dropped_clients(), 4U);
}

TEST_F(LiveServerTest, SilentClientsLockNobodyOut) {
  auto server = LiveServer::open(path_).value();
  StreamClient reader(path_);
  std::vector<std::unique_ptr<StreamClient>> silent;
  while (silent.size() < LiveServer::kMaxClients - 1) silent.push_back(std::make_unique<StreamClient>(path_));
  server.publish("one\n");
  EXPECT_EQ(reader.read(), "one\n");
  server.publish("two\n");
  EXPECT_EQ(reader.read(), "two\n");
  StreamClient late(path_), later(path_);
  server.publish("three\n");
  EXPECT_EQ(late.read(), "three\n");
  EXPECT_EQ(later.read(), "three\n");
  EXPECT_EQ(reader.read(), "three\n") << "who reads keeps its place";
  EXPECT_EQ(server.clients(), LiveServer::kMaxClients);
  EXPECT_EQ(server.dropped_clients(), 2U);
}

TEST_F(LiveServerTest, ItTakesOverFromADeadCoreAndFromNoLivingOne) {
  {
    auto first = LiveServer::open(path_).value();
    EXPECT_FALSE(LiveServer::open(path_)) << "it is served";
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
  { support::AbandonedSocket dead(path_); }
  ASSERT_TRUE(std::filesystem::exists(path_));
  EXPECT_TRUE(LiveServer::open(path_));
}

TEST_F(LiveServerTest, AFileIsNotReplacedAndALongPathRefused) {
  std::ofstream(path_) << "precious";
  EXPECT_FALSE(LiveServer::open(path_));
  EXPECT_TRUE(std::filesystem::is_regular_file(path_));
  EXPECT_EQ(LiveServer::open(std::string(200, 'x')).error().code, Errc::kInvalidConfig);
  EXPECT_FALSE(LiveServer::open(folder_ / "no" / "folder"));
}

}  // namespace
}  // namespace cairn::app
