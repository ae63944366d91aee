// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/sockets/local_server.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "drivers/clients/sockets/local_client.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::clients {
namespace {

using Got = LocalServer::Got;
constexpr std::size_t kMost = 100;
const std::vector<std::byte> kMessage(10, std::byte{3});

class LocalServerTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path() const { return folder_ / "robot.sock"; }
  [[nodiscard]] LocalServer open(std::size_t clients = 2) const {
    return LocalServer::open({.path = path(), .most_clients = clients, .waiting_bytes = 8192}).value();
  }
  [[nodiscard]] LocalClient connect() const { return LocalClient::connect(path()).value(); }
  LocalServer::Received receive(LocalServer& server) { return server.receive(bytes_, kMost); }
  LocalClient::Got receive(LocalClient& client) { return client.receive(bytes_, kMost, Duration{}); }

  support::TemporaryFolder folder_;
  std::vector<std::byte> bytes_;
};

TEST_F(LocalServerTest, CarriesMessagesBothWays) {
  LocalServer server = open();
  LocalClient client = connect();
  const auto joined = receive(server);
  ASSERT_EQ(joined.got, Got::kJoined);
  EXPECT_EQ(receive(server).got, Got::kNothing);
  ASSERT_TRUE(client.send(kMessage));
  const auto record = receive(server);
  EXPECT_EQ(record.got, Got::kRecord);
  EXPECT_EQ(record.client, joined.client);
  EXPECT_EQ(bytes_, kMessage);
  ASSERT_TRUE(server.send(joined.client, kMessage));
  EXPECT_EQ(receive(client), LocalClient::Got::kMessage);
  EXPECT_EQ(bytes_, kMessage);
  EXPECT_EQ(receive(client), LocalClient::Got::kNothing);
}

TEST_F(LocalServerTest, SaysWhoLeft) {
  LocalServer server = open();
  LocalServer::ClientId first = 0;
  {
    const LocalClient client = connect();
    first = receive(server).client;
  }
  const auto left = receive(server);
  EXPECT_EQ(left.got, Got::kLeft);
  EXPECT_EQ(left.client, first);
  EXPECT_EQ(server.clients(), 0U);
  EXPECT_FALSE(server.send(first, kMessage));
  const LocalClient next = connect();
  EXPECT_NE(receive(server).client, first) << "a number is not used again at once";
}

TEST_F(LocalServerTest, ADroppedClientLeaves) {
  LocalServer server = open();
  LocalClient client = connect();
  const auto id = receive(server).client;
  server.drop(id);
  EXPECT_EQ(receive(client), LocalClient::Got::kEnd);
  EXPECT_EQ(receive(server).got, Got::kLeft);
}

TEST_F(LocalServerTest, OneTooManyIsTurnedAway) {
  LocalServer server = open(1);
  const LocalClient first = connect();
  LocalClient second = connect();
  EXPECT_EQ(receive(server).got, Got::kJoined);
  EXPECT_EQ(receive(server).got, Got::kNothing);
  EXPECT_EQ(receive(second), LocalClient::Got::kEnd);
  EXPECT_EQ(server.turned_away(), 1U);
}

TEST_F(LocalServerTest, WhatCanWaitLeavesRoomForWhatCannot) {
  LocalServer server = open();
  LocalClient client = connect();
  const auto id = receive(server).client;
  int bulk = 0, urgent = 0;
  while (server.send_bulk(id, kMessage)) ASSERT_LT(++bulk, 100'000);
  while (server.send(id, kMessage)) ASSERT_LT(++urgent, 100'000);
  EXPECT_GT(bulk, 0);
  EXPECT_GT(urgent, 0);
  while (receive(client) == LocalClient::Got::kMessage) continue;
  EXPECT_TRUE(server.send_bulk(id, kMessage));
  EXPECT_FALSE(server.send_bulk(99, kMessage));
}

TEST_F(LocalServerTest, ADeafClientCostsItsOwnMessages) {
  LocalServer server = open();
  LocalClient deaf = connect(), reader = connect();
  const auto deaf_id = receive(server).client, reader_id = receive(server).client;
  int sent = 0;
  while (server.send(deaf_id, kMessage)) ASSERT_LT(++sent, 100'000);
  EXPECT_GT(sent, 0);
  EXPECT_TRUE(server.send(reader_id, kMessage));
  EXPECT_EQ(receive(reader), LocalClient::Got::kMessage);
}

TEST_F(LocalServerTest, ATalkerDoesNotKeepOthersFromBeingHeard) {
  LocalServer server = open();
  LocalClient loud = connect(), quiet = connect();
  const auto loud_id = receive(server).client, quiet_id = receive(server).client;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(loud.send(kMessage));
  ASSERT_TRUE(quiet.send(kMessage));
  const auto first = receive(server).client, second = receive(server).client;
  EXPECT_EQ(std::min(first, second), loud_id);
  EXPECT_EQ(std::max(first, second), quiet_id);
}

TEST_F(LocalServerTest, TooLongAMessageShows) {
  LocalServer server = open();
  LocalClient client = connect();
  (void)receive(server);
  ASSERT_TRUE(client.send(std::vector<std::byte>(kMost + 50)));
  EXPECT_EQ(receive(server).got, Got::kRecord);
  EXPECT_EQ(bytes_.size(), kMost + 1);
}

TEST_F(LocalServerTest, OneServerToAPath) {
  {
    const LocalServer server = open();
    EXPECT_EQ(LocalServer::open({.path = path()}).error().code, Errc::kIo);
  }
  EXPECT_FALSE(std::filesystem::exists(path()));
  EXPECT_EQ(LocalClient::connect(path()).error().code, Errc::kNotFound);
  std::ofstream(path()) << "not a socket";
  EXPECT_FALSE(LocalServer::open({.path = path()}));
  EXPECT_EQ(std::filesystem::file_size(path()), 12U) << "a file of somebody is not replaced";
}

TEST_F(LocalServerTest, OnlyOwnerAndGroupMayConnect) {
  const LocalServer server = open();
  const auto others = std::filesystem::status(path()).permissions() & std::filesystem::perms::others_all;
  EXPECT_EQ(others, std::filesystem::perms::none);
}

TEST_F(LocalServerTest, APathThatIsTooLongIsSaid) {
  const std::filesystem::path path = folder_ / std::string(120, 'x');
  EXPECT_EQ(LocalServer::open({.path = path}).error().code, Errc::kInvalidConfig);
  EXPECT_EQ(LocalClient::connect(path).error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace cairn::clients
