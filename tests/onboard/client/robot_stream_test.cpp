// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/robot_stream.hpp"

#include <gtest/gtest.h>

#include "drivers/clients/sockets/local_server.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::client {
namespace {

using clients::LocalServer;
using clients::RecordKind;

/// A core that says what the test wants.
class StandIn {
 public:
  explicit StandIn(const std::filesystem::path& path) : server_(LocalServer::open({.path = path}).value()) {}

  /// What came since the last call, as numbers of records; remembers who sent it and the last subscription.
  void hear() {
    for (;;) {
      const auto got = server_.receive(bytes_, 1000);
      if (got.got == LocalServer::Got::kNothing) return;
      client_ = got.client;
      if (got.got != LocalServer::Got::kRecord) continue;
      const auto record = clients::decode_record(bytes_);
      ASSERT_TRUE(record);
      subscription = clients::decode_subscribe(record->body).value();
    }
  }
  template <class Message>
  void say(std::uint32_t sequence, const Message& message) {
    clients::begin_record(Message::kKind, sequence, bytes_);
    encode(message, bytes_);
    clients::end_record(bytes_);
    ASSERT_TRUE(server_.send(client_, bytes_));
  }
  void say_bytes(const std::vector<std::byte>& bytes) { ASSERT_TRUE(server_.send(client_, bytes)); }

  std::optional<SubscribeMessage> subscription;

 private:
  LocalServer server_;
  LocalServer::ClientId client_ = 0;
  std::vector<std::byte> bytes_;
};

const HelloMessage kHello{.robot = "husky", .session = 5, .resolution_m = 0.2};

class RobotStreamTest : public ::testing::Test {
 protected:
  support::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "robot.sock";
};

TEST_F(RobotStreamTest, SaysThatNoCoreIsThere) {
  const auto stream = RobotStream::connect(path_, {});
  ASSERT_FALSE(stream);
  EXPECT_EQ(stream.error().code, Errc::kNotFound);
}

TEST_F(RobotStreamTest, GivesMessagesAndCountsWhatIsMissing) {
  StandIn core(path_);
  SubscribeMessage wants;
  wants.add(clients::Stream::kPose);
  auto stream = RobotStream::connect(path_, wants).value();
  core.hear();
  ASSERT_TRUE(core.subscription);
  EXPECT_TRUE(core.subscription->wants(clients::Stream::kPose));
  core.say(0, kHello);
  core.say(1, PoseMessage{});
  core.say(5, EventMessage{.stage = "odometry", .what = "lost"});
  EXPECT_TRUE(std::holds_alternative<HelloMessage>(stream.next(Duration{}).value()));
  EXPECT_TRUE(std::holds_alternative<PoseMessage>(stream.next(Duration{}).value()));
  EXPECT_TRUE(std::holds_alternative<EventMessage>(stream.next(Duration{}).value()));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(stream.next(Duration{}).value()));
  EXPECT_EQ(stream.lost(), 3U);
}

TEST_F(RobotStreamTest, GoesOnAfterBytesThatAreNoRecord) {
  StandIn core(path_);
  auto stream = RobotStream::connect(path_, {}).value();
  core.hear();
  core.say_bytes(std::vector<std::byte>(40, std::byte{1}));
  core.say(0, kHello);
  EXPECT_FALSE(stream.next(Duration{}));
  EXPECT_TRUE(std::holds_alternative<HelloMessage>(stream.next(Duration{}).value()));
}

TEST_F(RobotStreamTest, ARecordOfAKindToComeIsLeftAlone) {
  StandIn core(path_);
  auto stream = RobotStream::connect(path_, {}).value();
  core.hear();
  std::vector<std::byte> record;
  clients::begin_record(static_cast<RecordKind>(31), 0, record);
  clients::end_record(record);
  core.say_bytes(record);
  core.say(1, kHello);
  EXPECT_TRUE(std::holds_alternative<HelloMessage>(stream.next(Duration{}).value()));
}

TEST_F(RobotStreamTest, FindsTheNextCoreAndSaysWhatItHas) {
  std::optional<StandIn> core(path_);
  auto stream = RobotStream::connect(path_, {}).value();
  core->hear();
  core->say(0, kHello);
  EXPECT_TRUE(std::holds_alternative<HelloMessage>(stream.next(Duration{}).value()));
  core.reset();
  EXPECT_TRUE(std::holds_alternative<CoreGone>(stream.next(Duration{}).value()));
  EXPECT_FALSE(stream.connected());
  EXPECT_TRUE(std::holds_alternative<std::monostate>(stream.next(Duration{}).value()));
  stream.wants().own = {5, 0, 99};
  core.emplace(path_);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(stream.next(Duration{}).value()));
  EXPECT_TRUE(stream.connected());
  core->hear();
  ASSERT_TRUE(core->subscription);
  EXPECT_EQ(core->subscription->own.version, 99U);
  EXPECT_EQ(stream.lost(), 0U);
}

}  // namespace
}  // namespace cairn::client
