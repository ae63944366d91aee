// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/commands/command_socket.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "drivers/clients/commands/command_packet.hpp"
#include "drivers/clients/sockets/local_client.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::clients {
namespace {

class CommandSocketTest : public ::testing::Test {
 protected:
  [[nodiscard]] LocalClient connect() const { return LocalClient::connect(path_).value(); }
  /// The next packet; none: nothing is there.
  std::optional<Packet> next() {
    Packet packet;
    if (socket_->next(packet, {}).value() != Poll::kPacket) return std::nullopt;
    return packet;
  }
  static std::vector<std::byte> command(std::uint32_t number) {
    std::vector<std::byte> bytes;
    encode(Command{.verb = Command::Verb::kHold, .number = number, .who = ClientName("test")}, bytes);
    return bytes;
  }

  support::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "command.sock";
  VirtualClock clock_;
  std::unique_ptr<CommandSocket> socket_ = CommandSocket::open(path_, SourceId{3}, clock_).value();
};

TEST_F(CommandSocketTest, CommandsBecomePackets) {
  EXPECT_FALSE(next());
  LocalClient client = connect();
  ASSERT_TRUE(client.send(command(1)));
  const auto joined = next(), commanded = next();
  ASSERT_TRUE(joined && commanded);
  EXPECT_TRUE(is_joined(*joined));
  EXPECT_EQ(commanded->bytes, command(1));
  EXPECT_EQ(commanded->channel, joined->channel);
  EXPECT_EQ(commanded->source, SourceId{3});
  EXPECT_EQ(commanded->arrival, clock_.now());
  EXPECT_FALSE(next());
}

TEST_F(CommandSocketTest, AnswersReachTheClientThatAsked) {
  LocalClient first = connect(), second = connect();
  const auto id = next()->channel;
  (void)next();
  ASSERT_TRUE(socket_->answer(id, Answer{.outcome = Answer::Outcome::kDone, .number = 1, .holder = {}, .why = {}}));
  std::vector<std::byte> bytes;
  EXPECT_EQ(second.receive(bytes, 500, {}), LocalClient::Got::kNothing);
  ASSERT_EQ(first.receive(bytes, 500, {}), LocalClient::Got::kMessage);
  EXPECT_EQ(decode_answer(bytes).value().number, 1U);
}

TEST_F(CommandSocketTest, WhoSendsGarbageIsDropped) {
  LocalClient client = connect();
  ASSERT_TRUE(client.send(std::vector<std::byte>(40, std::byte{1})));
  ASSERT_TRUE(is_joined(*next()));
  const auto left = next();
  ASSERT_TRUE(left);
  EXPECT_TRUE(is_left(*left));
  EXPECT_EQ(socket_->counters().refused, 1U);
  std::vector<std::byte> bytes;
  EXPECT_EQ(client.receive(bytes, 500, {}), LocalClient::Got::kEnd);
}

TEST_F(CommandSocketTest, AFloodComesInPieces) {
  LocalClient client = connect();
  std::uint32_t sent = 0;
  while (sent < 100 && client.send(command(sent + 1))) ++sent;
  ASSERT_GT(sent, 0U);
  int in_a_row = 0, packets = 0;
  for (int nothing = 0; nothing < 2;) {
    if (next()) {
      ++packets, ++in_a_row, nothing = 0;
      EXPECT_LE(in_a_row, CommandSocket::kMostInARow);
    } else {
      in_a_row = 0, ++nothing;
      while (sent < 100 && client.send(command(sent + 1))) ++sent;
    }
  }
  EXPECT_EQ(packets, 101);
}

}  // namespace
}  // namespace cairn::clients
