// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/live/can_hub.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "drivers/clients/sockets/local_client.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::simulator {
namespace {

using namespace std::chrono_literals;
using drive::CanFrame;
using drive::make_frame;
using drive::SendResult;
using drive::UnixCanLink;

class CanHubTest : public testing::Test {
 protected:
  void SetUp() override { hub = CanHub::open(name, clock).value(); }
  std::unique_ptr<UnixCanLink> join() { return UnixCanLink::open(name, SourceId{0}, clock).value(); }
  /// The next frame that others sent.
  std::optional<CanFrame> next(drive::CanLink& link) {
    while (link.next(packet, 0s).value() == Poll::kPacket)
      if (packet.channel == static_cast<std::uint16_t>(drive::Direction::kReceived))
        return drive::decode_frame(packet.payload()).value();
    return std::nullopt;
  }

  support::TemporaryFolder folder;
  LiveClock clock;
  std::string name = "unix:" + (folder / "can").string();
  std::unique_ptr<CanHub> hub;
  Packet packet;
  const CanFrame some = make_frame(0x201, {1, 2, 3}), other = make_frame(0x181, {9});
};

TEST_F(CanHubTest, AFrameReachesAllOthers) {
  const auto one = join(), two = join();
  EXPECT_FALSE(next(*hub));
  const Time before = clock.now();
  ASSERT_EQ(one->send(some), SendResult::kSent);
  const Time after = clock.now();
  EXPECT_EQ(next(*hub), some);
  EXPECT_GE(packet.arrival, before - 1ms);
  if (clock.now() - before < 500ms) {  // a link takes no stamp that is a second old: else the machine was held up
    EXPECT_LE(packet.arrival, after + 1ms) << "the time when it was sent";
  }
  EXPECT_EQ(next(*two), some);
  EXPECT_FALSE(next(*one)) << "its own frame comes back as sent";
  ASSERT_EQ(hub->send(other), SendResult::kSent);
  EXPECT_EQ(next(*one), other);
  EXPECT_EQ(next(*two), other);
  EXPECT_FALSE(next(*hub)) << "nothing of its own comes back";
}

TEST_F(CanHubTest, FramesOfOneProgramKeepTheirOrder) {
  const auto one = join();
  for (std::uint8_t i = 0; i < 20; ++i) ASSERT_EQ(one->send(make_frame(0x100, {i})), SendResult::kSent);
  for (std::uint8_t i = 0; i < 20; ++i) EXPECT_EQ(next(*hub), make_frame(0x100, {i}));
}

TEST_F(CanHubTest, WhatIsNoFrameIsRefused) {
  auto hostile = clients::LocalClient::connect(folder / "can").value();
  const auto one = join();
  const std::vector<std::byte> rubbish(4000, std::byte{0xFF});
  for (const std::size_t size : {std::size_t{1}, std::size_t{16}, std::size_t{72}, rubbish.size()})
    ASSERT_TRUE(hostile.send(std::span(rubbish).first(size)));
  ASSERT_EQ(one->send(some), SendResult::kSent);
  int refused = 0;
  std::optional<CanFrame> got;
  for (auto poll = hub->next(packet, 0s); !poll || *poll == Poll::kPacket; poll = hub->next(packet, 0s)) {
    if (poll) got = drive::decode_frame(packet.payload()).value();
    if (poll) continue;
    EXPECT_EQ(poll.error().code, Errc::kMalformed);
    ++refused;
  }
  EXPECT_EQ(refused, 4);
  EXPECT_EQ(got, some);
  EXPECT_FALSE(next(*one)) << "nobody else sees rubbish";
}

TEST_F(CanHubTest, AProgramThatDoesNotReadHoldsNobody) {
  const auto deaf = join(), one = join();
  EXPECT_FALSE(next(*hub));
  int full = 0;
  for (int i = 0; i < 1000; ++i) {
    full += hub->send(other) == SendResult::kQueueFull ? 1 : 0;
    ASSERT_EQ(next(*one), other);
    ASSERT_FALSE(next(*hub));
  }
  EXPECT_GT(full, 500);
}

TEST_F(CanHubTest, ProgramsComeAndGo) {
  for (int i = 0; i < 50; ++i) {
    const auto one = join();
    ASSERT_EQ(one->send(some), SendResult::kSent);
    ASSERT_EQ(next(*hub), some);
    ASSERT_FALSE(next(*hub));
  }
  EXPECT_FALSE(next(*hub));
  EXPECT_FALSE(next(*hub)) << "who has gone is forgotten";
  EXPECT_EQ(hub->clients(), 0U);
  std::vector<std::unique_ptr<UnixCanLink>> many;
  for (std::size_t i = 0; i < CanHub::kMaxClients; ++i) {
    many.push_back(join());
    EXPECT_FALSE(next(*hub));
  }
  many.push_back(join());
  EXPECT_EQ(hub->next(packet, 0s).error().code, Errc::kLimit);
  EXPECT_EQ(hub->clients(), CanHub::kMaxClients);
  EXPECT_FALSE(many.back()->next(packet, 0s)) << "the last one is told that the bus is gone";
}

TEST_F(CanHubTest, ASecondOwnerIsRefusedAndALeftNameIsReplaced) {
  const auto second = CanHub::open(name, clock);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kIo);
  EXPECT_NE(to_string(second.error()).find("--can"), std::string::npos);
  hub.reset();
  EXPECT_FALSE(std::filesystem::exists(folder / "can"));
  std::ofstream(folder / "can") << "a file of somebody";
  EXPECT_FALSE(CanHub::open(name, clock));
  EXPECT_TRUE(std::filesystem::exists(folder / "can")) << "what is no socket stays";
  EXPECT_EQ(CanHub::open("unix:", clock).error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace cairn::simulator
