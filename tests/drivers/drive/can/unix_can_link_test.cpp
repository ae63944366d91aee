// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/unix_can_link.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <optional>
#include <string>
#include <vector>

#include "drivers/drive/can/candump.hpp"
#include "drivers/drive/chassis/config.hpp"
#include "tests/support/local_socket.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::drive {
namespace {

using namespace std::chrono_literals;

/// The program that plays the bus.
class BusServer {
 public:
  explicit BusServer(const std::string& path) : path_(path), listening_(::socket(AF_UNIX, SOCK_SEQPACKET, 0)) {
    const support::LocalAddress address(path);
    EXPECT_EQ(::bind(listening_, address.get(), address.length()), 0);
    EXPECT_EQ(::listen(listening_, 4), 0);
  }
  BusServer(const BusServer&) = delete;
  BusServer& operator=(const BusServer&) = delete;
  ~BusServer() {
    hang_up();
    ::close(listening_);
    ::unlink(path_.c_str());
  }
  void accept() { client_ = ::accept(listening_, nullptr, nullptr); }
  void hang_up() {
    if (client_ >= 0) ::close(client_);
    client_ = -1;
  }
  void send(std::span<const std::byte> record) const {
    EXPECT_EQ(::send(client_, record.data(), record.size(), MSG_NOSIGNAL), static_cast<ssize_t>(record.size()));
  }
  void send(const CanFrame& frame) const {
    Packet packet;
    encode_frame(frame, packet);
    send(packet.payload());
  }
  /// The next frame of the client, where one is there.
  [[nodiscard]] std::optional<CanFrame> receive() const {
    std::array<std::byte, 100> bytes{};
    const ssize_t size = ::recv(client_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size < 0) return std::nullopt;
    return decode_frame(std::span(bytes).first(static_cast<std::size_t>(size))).value();
  }

 private:
  std::string path_;
  int listening_ = -1, client_ = -1;
};

class UnixCanLinkTest : public testing::Test {
 protected:
  void connect() {
    server.emplace((folder / "can").string());
    auto opened = UnixCanLink::open(name(), SourceId{4}, clock);
    ASSERT_TRUE(opened) << to_string(opened.error());
    link = std::move(*opened);
    server->accept();
  }
  [[nodiscard]] std::string name() const { return "unix:" + (folder / "can").string(); }

  support::TemporaryFolder folder;
  LiveClock clock;
  std::optional<BusServer> server;
  std::unique_ptr<UnixCanLink> link;
  Packet packet;
};

const CanFrame kSome = make_frame(0x181, {1, 2, 3, 4, 5, 6, 7, 8});

TEST_F(UnixCanLinkTest, FramesCrossBothWays) {
  connect();
  const Time before = clock.now();
  server->send(kSome);
  ASSERT_EQ(link->next(packet, 0s).value(), Poll::kPacket);
  EXPECT_EQ(decode_frame(packet.payload()).value(), kSome);
  EXPECT_EQ(packet.channel, static_cast<std::uint16_t>(Direction::kReceived));
  EXPECT_EQ(packet.source, SourceId{4});
  EXPECT_GE(packet.arrival, before - 1ms);
  const Time after = clock.now();
  EXPECT_LE(packet.arrival, after);
  EXPECT_EQ(packet.arrival, std::chrono::floor<CandumpTick>(packet.arrival)) << "a recording must hold it";
  if (after - before < 500ms) {  // the link takes no stamp that is a second old: else the machine was held up
    EXPECT_EQ(link->counters().unstamped, 0U) << "the kernel stamps records of Unix sockets";
  }
  CanFrame longer;
  longer.id = 0x155;
  longer.fd = true;
  longer.length = 64;
  for (const CanFrame& frame : {make_frame(0x1ABCDEF | kExtended, {}), make_frame(0x321 | kRemote, {}), longer}) {
    ASSERT_EQ(link->send(frame), SendResult::kSent);
    EXPECT_EQ(server->receive(), frame);
    ASSERT_EQ(link->next(packet, 0s).value(), Poll::kPacket) << "own frames come back once they are sent";
    EXPECT_EQ(decode_frame(packet.payload()).value(), frame);
    EXPECT_EQ(packet.channel, static_cast<std::uint16_t>(Direction::kSent));
  }
  EXPECT_EQ(link->next(packet, 0s).value(), Poll::kTimeout);
  EXPECT_EQ(link->counters().own, 3U);
}

TEST_F(UnixCanLinkTest, ForeignRecordsAreHandedOnToBeRefused) {
  connect();
  const std::vector<std::byte> longest(5000, std::byte{0xFF});
  for (const std::size_t size : {std::size_t{1}, std::size_t{15}, std::size_t{17}, std::size_t{71}, longest.size()}) {
    server->send(std::span(longest).first(size));
    ASSERT_EQ(link->next(packet, 0s).value(), Poll::kPacket);
    EXPECT_EQ(packet.bytes.size(), std::min(size, kFdBytes));
    EXPECT_EQ(packet.truncated, size > kFdBytes);
    EXPECT_FALSE(decode_frame(packet.payload())) << size;
  }
}

TEST_F(UnixCanLinkTest, SendingNeverWaits) {
  connect();
  int sent = 0;
  while (link->send(kSome) == SendResult::kSent) {
    ++sent;
    ASSERT_EQ(link->next(packet, 0s).value(), Poll::kPacket);
    ASSERT_LT(sent, 1000);
  }
  EXPECT_GT(sent, 8) << "one tick's frames have room";
  EXPECT_EQ(link->send(kSome), SendResult::kQueueFull);
  EXPECT_TRUE(server->receive());
  while (server->receive()) {
  }
  EXPECT_EQ(link->send(kSome), SendResult::kSent);
}

TEST_F(UnixCanLinkTest, OwnFramesThatNobodyTakesAreBounded) {
  connect();
  std::size_t sent = 0;
  for (; link->send(kSome) == SendResult::kSent; ++sent) (void)server->receive();
  EXPECT_EQ(sent, UnixCanLink::kMostOwn);
  EXPECT_FALSE(server->receive()) << "a frame that is refused is not sent";
}

TEST_F(UnixCanLinkTest, ABusThatComesBackIsOpenedAgain) {
  VirtualClock time;
  server.emplace((folder / "can").string());
  auto opened = UnixCanLink::open(name(), SourceId{4}, time).value();
  server->accept();
  server.reset();
  const auto lost = opened->next(packet, 0s);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, Errc::kLinkDown);
  EXPECT_EQ(opened->send(kSome), SendResult::kDown);
  server.emplace((folder / "can").string());
  EXPECT_EQ(opened->next(packet, 0s).value(), Poll::kTimeout) << "too early for another try";
  EXPECT_FALSE(opened->is_open());
  time.advance_to(time.now() + SocketLink::kFirstRetry);
  EXPECT_EQ(opened->next(packet, 0s).value(), Poll::kTimeout);
  ASSERT_TRUE(opened->is_open());
  EXPECT_EQ(opened->counters().reopened, 1U);
  EXPECT_EQ(opened->send(kSome), SendResult::kSent);
}

TEST_F(UnixCanLinkTest, WhatCannotBeOpenedIsSaidWithTheRemedy) {
  const auto none = open_link(name(), SourceId{0}, clock);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kNotFound);
  EXPECT_NE(to_string(none.error()).find("simulate --live"), std::string::npos);
  for (const std::string& bad : {std::string("unix:"), "unix:/" + std::string(200, 'x')})
    EXPECT_EQ(open_link(bad, SourceId{0}, clock).error().code, Errc::kInvalidConfig);
}

TEST_F(UnixCanLinkTest, AProfileMayNameIt) {
  Config config;
  config.interface = name();
  EXPECT_TRUE(check(config));
  for (const std::string& bad : {std::string("unix:"), std::string("can0/x"), "unix:/" + std::string(200, 'x')}) {
    config.interface = bad;
    EXPECT_FALSE(check(config)) << bad;
  }
}

}  // namespace
}  // namespace cairn::drive
