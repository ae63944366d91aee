// SPDX-License-Identifier: Apache-2.0
// The drive on a real kernel's CAN: vcan, or two controllers on one bus. Without CAIRN_TEST_CAN everything is skipped.
#include <gtest/gtest.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "drivers/drive/can/socketcan_link.hpp"
#include "drivers/drive/can_drive.hpp"
#include "tests/drivers/drive/virtual_bus.hpp"

namespace cairn::drive {
namespace {

using namespace std::chrono_literals;

/// Sets an interface up or down, as `ip link set` does; false where that is not allowed.
bool set_up(const std::string& interface, bool up) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  bool done = ioctl(fd, SIOCGIFFLAGS, &request) == 0;
  const int flags = up ? request.ifr_flags | IFF_UP : request.ifr_flags & ~IFF_UP;
  request.ifr_flags = static_cast<short>(flags);
  done = done && ioctl(fd, SIOCSIFFLAGS, &request) == 0;
  close(fd);
  return done;
}

class DriveDeviceTest : public testing::Test {
 protected:
  void SetUp() override {
    const char* own = std::getenv("CAIRN_TEST_CAN");
    const char* other = std::getenv("CAIRN_TEST_CAN_PEER");
    if (own == nullptr) GTEST_SKIP() << "CAIRN_TEST_CAN names no CAN interface";
    interface = own;
    link = open(own);
    peer = open(other != nullptr ? other : own);
    shared = other == nullptr;
    ASSERT_TRUE(link && peer);
  }
  std::unique_ptr<SocketCanLink> open(const std::string& name) {
    auto opened = SocketCanLink::open(name, SourceId{1}, clock);
    EXPECT_TRUE(opened) << to_string(opened.error());
    return opened ? std::move(*opened) : nullptr;
  }
  /// The next frame that `from` gives within 2 s and that is `wanted`.
  template <class Wanted>
  std::optional<CanFrame> await(SocketCanLink& from, Wanted wanted) {
    for (const Time end = clock.now() + 2s; clock.now() < end;) {
      const auto poll = from.next(packet, 100ms);
      if (!poll || *poll != Poll::kPacket) continue;
      const auto frame = decode_frame(packet.payload());
      if (frame && wanted(*frame)) return *frame;
    }
    return std::nullopt;
  }
  std::optional<CanFrame> await(SocketCanLink& from, const CanFrame& frame) {
    return await(from, [&](const CanFrame& f) { return f == frame; });
  }

  LiveClock clock;
  std::string interface;
  bool shared = false;  // both ends on one interface: a vcan
  std::unique_ptr<SocketCanLink> link, peer;
  Packet packet;
};

TEST_F(DriveDeviceTest, FramesCrossWithTheKernelsStamp) {
  for (const CanFrame& frame :
       {make_frame(0x123, {1, 2, 3}), make_frame(0x1ABCDEF | kExtended, {}), make_frame(0x321 | kRemote, {})}) {
    const Time before = clock.now();
    ASSERT_EQ(link->send(frame), SendResult::kSent);
    ASSERT_TRUE(await(*peer, frame));
    EXPECT_GE(packet.arrival, before - 1ms);
    EXPECT_LE(packet.arrival, clock.now());
    EXPECT_EQ(packet.channel, static_cast<std::uint16_t>(Direction::kReceived));
    ASSERT_TRUE(await(*link, frame)) << "own frames come back once they are sent";
    EXPECT_EQ(packet.channel, static_cast<std::uint16_t>(Direction::kSent));
  }
  EXPECT_EQ(peer->counters().unstamped, 0U);
}

TEST_F(DriveDeviceTest, FdFramesKeepTheirBytes) {
  if (!shared) GTEST_SKIP() << "the controllers may not know CAN FD";
  CanFrame frame;
  frame.id = 0x155;
  frame.fd = true;
  frame.fd_flags = kFdBitRateSwitch;
  frame.length = 64;
  for (std::size_t i = 0; i < 64; ++i) frame.data[i] = static_cast<std::uint8_t>(i);
  if (link->send(frame) != SendResult::kSent)
    GTEST_SKIP() << "the interface carries classic frames only (ip link set … mtu 72)";
  const auto received = await(*peer, [](const CanFrame& f) { return f.fd; });
  ASSERT_TRUE(received);
  EXPECT_EQ(received->data, frame.data);
}

TEST_F(DriveDeviceTest, ErrorFramesAreDelivered) {
  if (!shared) GTEST_SKIP() << "a controller's own error frames cannot be made to order";
  const CanFrame passive = make_frame(kErrorFrame | kErrorController, {0, 0x20, 0, 0, 0, 0, 0, 0});
  ASSERT_EQ(peer->send(passive), SendResult::kSent);
  const auto received = await(*link, [](const CanFrame& f) { return f.error(); });
  ASSERT_TRUE(received);
  LinkMonitor monitor;
  monitor.receive(*received, packet.arrival);
  EXPECT_EQ(monitor.state(), LinkMonitor::State::kErrorPassive);
}

TEST_F(DriveDeviceTest, SendingNeverBlocks) {
  const CanFrame frame = make_frame(0x7FF, {0, 0, 0, 0, 0, 0, 0, 0});
  for (int i = 0; i < 5000; ++i) ASSERT_NE(link->send(frame), SendResult::kDown);
  while (*link->next(packet, 200ms) == Poll::kPacket) {
  }
  EXPECT_EQ(link->send(frame), SendResult::kSent) << "and goes on when the bus has carried them";
}

TEST_F(DriveDeviceTest, AFullQueueIsSaidAndPasses) {
  const char* slow = std::getenv("CAIRN_TEST_CAN_SLOW");
  if (slow == nullptr) GTEST_SKIP() << "CAIRN_TEST_CAN_SLOW names no slow CAN interface";
  const auto bus = open(slow);
  ASSERT_TRUE(bus);
  const CanFrame frame = make_frame(0x7FF, {0, 0, 0, 0, 0, 0, 0, 0});
  int full = 0;
  for (int i = 0; i < 200; ++i) full += bus->send(frame) == SendResult::kQueueFull ? 1 : 0;
  EXPECT_GT(full, 100) << "most of them find no room";
  EXPECT_LT(full, 200) << "some do";
  while (*bus->next(packet, 1s) == Poll::kPacket) {
  }
  EXPECT_EQ(bus->send(frame), SendResult::kSent) << "and goes on when the bus has carried them";
}

TEST_F(DriveDeviceTest, AnInterfaceThatComesBackIsOpenedAgain) {
  if (!set_up(interface, true)) GTEST_SKIP() << "may not set interfaces up and down (CAP_NET_ADMIN)";
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(set_up(interface, false));
    bool lost = false;
    for (const Time end = clock.now() + 2s; !lost && clock.now() < end;) lost = !link->next(packet, 50ms);
    EXPECT_TRUE(lost);
    EXPECT_EQ(link->send(make_frame(0x100, {})), SendResult::kDown);
    ASSERT_TRUE(set_up(interface, true));
    for (const Time end = clock.now() + 3s; !link->is_open() && clock.now() < end;) (void)link->next(packet, 50ms);
    ASSERT_TRUE(link->is_open());
  }
  EXPECT_EQ(link->counters().reopened, 3U);
}

/// The nodes live on the other end of the bus, in the same thread: whoever has a frame is served.
TEST_F(DriveDeviceTest, BringsACia402DriveUpAndDrivesIt) {
  auto drive = CanDrive::create(test::two_nodes(), *link).value();
  simulator::DriveModelConfig left, right;
  right.node = 2;
  std::vector<simulator::DriveModel> nodes{simulator::DriveModel(left), simulator::DriveModel(right)};
  const auto serve = [&](auto act) {
    simulator::DriveModel::Frames out;
    for (auto& node : nodes) act(node, out);
    for (const CanFrame& frame : out) (void)peer->send(frame);
  };
  serve([&](auto& node, auto& out) { node.power_on(clock.now(), out); });
  std::optional<std::uint32_t> epoch;
  double fastest = 0;
  for (const Time end = clock.now() + 20s; clock.now() < end && fastest < 0.49;) {
    while (*peer->next(packet, 1ms) == Poll::kPacket) {
      if (packet.channel == static_cast<std::uint16_t>(Direction::kSent)) continue;
      const auto frame = decode_frame(packet.payload());
      if (frame) serve([&](auto& node, auto& out) { node.receive(*frame, clock.now(), out); });
    }
    serve([&](auto& node, auto& out) { node.step(clock.now(), out); });
    const Time now = clock.now();
    if (!epoch || drive->status().level == DriveLevel::kStop)
      if (const auto armed = drive->arm(now)) epoch = *armed;
    if (epoch) (void)drive->command({0.5, 0, *epoch}, now);
    if (const auto state = drive->tick(now); state && *state != nullptr) fastest = std::max(fastest, (*state)->v);
  }
  EXPECT_GE(fastest, 0.49);
  EXPECT_NEAR(nodes[0].speed() * 0.16, 0.5, 0.05);
  drive->stop(DriveCause::kRequested, clock.now());
  const auto stop =
      await(*peer, [](const CanFrame& f) { return f.is(canopen::kRpdo1 + 1) && f.data[0] == cia402::kQuickStop; });
  EXPECT_TRUE(stop);
}

}  // namespace
}  // namespace cairn::drive
