// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/transport/udp_source.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/velodyne/lidar.hpp"
#include "tests/support/allocation_count.hpp"
#include "tests/support/velodyne_encoder.hpp"

namespace cairn::velodyne {
namespace {

using namespace std::chrono_literals;

/// Sends datagrams over loopback. On a busy machine they may reach the receiver's buffer some time after send(), and
/// those of two senders in any order.
class Sender {
 public:
  explicit Sender(const char* from = "127.0.0.1") : fd_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address = to(0);
    inet_pton(AF_INET, from, &address.sin_addr);
    EXPECT_EQ(bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;
  ~Sender() { close(fd_); }
  void send(std::uint16_t port, const test::Bytes& bytes) const {
    const sockaddr_in address = to(port);
    ASSERT_EQ(sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof address),
              static_cast<ssize_t>(bytes.size()));
  }

 private:
  static sockaddr_in to(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }
  int fd_;
};

Config loopback() {
  Config c;
  c.bind_address = "127.0.0.1";
  c.data_port = 0;
  c.position_port = 0;
  c.max_packets_per_s = 100'000;
  return c;
}

class UdpSourceTest : public testing::Test {
 protected:
  static constexpr Duration kHang = 60s, kMoment = 10ms;
  static constexpr int kMoments = kHang / kMoment;

  void open(const Config& config) { source = UdpSource::open(config, SourceId{2}, clock).value(); }
  /// What a test waits for comes at once; only a fault lets the time run out.
  Poll next(Duration timeout = kHang) { return source->next(packet, timeout).value(); }

  LiveClock clock;
  std::unique_ptr<UdpSource> source;
  Packet packet;
  Sender sender;
};

TEST_F(UdpSourceTest, DeliversBothPortsWithKernelStamps) {
  constexpr Duration kTrusted = 500ms;  // the source takes no stamp that is a second old
  std::vector<Packet> packets(2);
  open(loopback());
  const Time before = clock.now();
  sender.send(source->data_port(), test::Bytes(1206, std::byte{1}));
  sender.send(source->position_port(), test::Bytes(512, std::byte{2}));
  for (Packet& p : packets) {
    ASSERT_EQ(next(), Poll::kPacket);
    p = packet;
  }
  const Time after = clock.now();
  std::size_t sizes = 0;
  for (const Packet& p : packets) {
    const bool data = p.channel == source->data_port();
    EXPECT_EQ(p.bytes, test::Bytes(data ? 1206 : 512, data ? std::byte{1} : std::byte{2}));
    EXPECT_EQ(p.sequence, &p == packets.data() ? 0U : 1U);
    EXPECT_EQ(p.source, SourceId{2});
    EXPECT_FALSE(p.truncated);
    EXPECT_GE(p.arrival, before - 1ms);  // the two clocks are read one after the other
    EXPECT_LE(p.arrival, after + 1ms);
    sizes += p.bytes.size();
  }
  EXPECT_EQ(sizes, 1206U + 512U);
  if (after - before < kTrusted) {  // else the machine was held up
    EXPECT_EQ(source->counters().unstamped, 0U);
  }
  EXPECT_EQ(next(0s), Poll::kTimeout);
}

TEST_F(UdpSourceTest, TimeOutWithoutTraffic) {
  open(loopback());
  EXPECT_EQ(next(1ms), Poll::kTimeout);
  EXPECT_EQ(next(-1s), Poll::kTimeout);
}

TEST_F(UdpSourceTest, OversizeDatagramsAreMarked) {
  open(loopback());
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, UdpSource::kMaxDatagram, UdpSource::kMaxDatagram + 1}) {
    sender.send(source->data_port(), test::Bytes(size));
    ASSERT_EQ(next(), Poll::kPacket);
    EXPECT_EQ(packet.truncated, size > UdpSource::kMaxDatagram);
    EXPECT_EQ(packet.bytes.size(), std::min(size, UdpSource::kMaxDatagram));
  }
  EXPECT_EQ(source->counters().truncated, 1U);
}

TEST_F(UdpSourceTest, OtherSendersAreIgnored) {
  Config config = loopback();
  config.source_address = "127.0.0.9";
  open(config);
  const Sender sensor("127.0.0.9");
  for (int i = 0; i < 10; ++i) sender.send(source->data_port(), test::Bytes(1206));
  sensor.send(source->data_port(), test::Bytes(1206, std::byte{9}));
  ASSERT_EQ(next(), Poll::kPacket);
  EXPECT_EQ(packet.bytes[0], std::byte{9});
  for (int i = 0; i < kMoments && source->counters().filtered < 10; ++i) EXPECT_EQ(next(kMoment), Poll::kTimeout);
  EXPECT_EQ(source->counters().filtered, 10U) << "the kernel drops them";
  EXPECT_EQ(source->counters().foreign + source->counters().kernel_drops, 0U);
}

/// Packets of a VLP-16.
class SensorPackets {
 public:
  test::Bytes next() {
    sensor_.next(packet_);
    return packet_.bytes;
  }

 private:
  test::Sensor sensor_;
  Packet packet_;
};

TEST_F(UdpSourceTest, TheFirstSenderOfValidPacketsIsHeardAlone) {
  Config config = loopback();
  config.receive_buffer_bytes = 65536;
  open(config);
  SensorPackets packets;
  for (int i = 0; i < SenderLearner::kEnough; ++i) {
    const Sender stranger("127.0.0.2");
    stranger.send(source->data_port(), test::Bytes(1206));
    sender.send(source->data_port(), packets.next());
    for (int k = 0; k < 2; ++k) ASSERT_EQ(next(), Poll::kPacket) << "nobody is known yet";
  }
  ASSERT_EQ(source->sender(), std::uint32_t{INADDR_LOOPBACK});
  // More than the buffer holds, before the sensor's packet: it is not pushed out.
  constexpr std::uint64_t kFlood = 2000;
  const Sender stranger("127.0.0.2");
  for (std::uint64_t i = 0; i < kFlood; ++i) stranger.send(source->data_port(), test::Bytes(1206));
  const test::Bytes wanted = packets.next();
  sender.send(source->data_port(), wanted);
  ASSERT_EQ(next(), Poll::kPacket);
  EXPECT_EQ(packet.bytes, wanted);
  for (int i = 0; i < kMoments && source->counters().filtered < kFlood; ++i) EXPECT_EQ(next(kMoment), Poll::kTimeout);
  EXPECT_EQ(source->counters().filtered, kFlood);
  EXPECT_EQ(source->counters().kernel_drops, 0U);
}

TEST_F(UdpSourceTest, FloodIsDroppedAndCannotHoldTheCaller) {
  Config config = loopback();
  config.max_packets_per_s = 100;  // ten in a RateWindow: a machine would have to be held up nine times to let all pass
  open(config);
  for (int i = 0; i < 100; ++i) sender.send(source->data_port(), test::Bytes(16));
  std::uint64_t before = 0;
  for (int i = 0; i < kMoments && source->counters().delivered + source->counters().flooded < 100; ++i) {
    (void)next(kMoment);
    EXPECT_LE(source->counters().flooded - before, static_cast<std::uint64_t>(UdpSource::kMaxLooked)) << "in one call";
    before = source->counters().flooded;
  }
  EXPECT_EQ(source->counters().delivered + source->counters().flooded, 100U);
  EXPECT_GT(source->counters().flooded, 0U);
}

TEST_F(UdpSourceTest, FullReceiveBufferIsNoticed) {
  Config config = loopback();
  config.receive_buffer_bytes = 4096;
  open(config);
  EXPECT_GT(source->counters().receive_buffer_bytes, 0);
  std::uint64_t sent = 0;
  const auto send = [&] { sender.send(source->data_port(), test::Bytes(1206)), ++sent; };
  while (sent < 200) send();
  const auto noticed = [&] { return source->counters().kernel_drops + source->counters().delivered; };
  for (int i = 0; i < kMoments && noticed() < sent; ++i)
    if (next(kMoment) == Poll::kTimeout) send();  // brings the drop count along
  EXPECT_GT(source->counters().kernel_drops, 0U);
  EXPECT_EQ(noticed(), sent);
}

TEST_F(UdpSourceTest, GrantsTheReceiveBufferThatWasAskedForOrSaysWhatItGot) {
  Config config = loopback();
  open(config);
  EXPECT_GE(source->counters().receive_buffer_bytes, 65536);
  config.receive_buffer_bytes = 65536;
  open(config);
  EXPECT_EQ(source->counters().receive_buffer_bytes, 2 * 65536) << "Linux doubles for its own bookkeeping";
}

TEST_F(UdpSourceTest, TakenPortNamesTheRemedy) {
  open(loopback());
  Config config = loopback();
  config.data_port = source->data_port();
  const auto second = UdpSource::open(config, {}, clock);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kIo);
  EXPECT_NE(to_string(second.error()).find(std::to_string(config.data_port)), std::string::npos);
  EXPECT_NE(second.error().detail.find("ss -lunp"), std::string::npos);
}

TEST_F(UdpSourceTest, ForeignBindAddressNamesTheRemedy) {
  Config config = loopback();
  config.bind_address = "203.0.113.7";
  const auto made = UdpSource::open(config, {}, clock);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().detail.find("bind_address"), std::string::npos);
  config.bind_address = "nonsense";
  EXPECT_EQ(UdpSource::open(config, {}, clock).error().code, Errc::kInvalidConfig);
}

TEST_F(UdpSourceTest, WarmReceivingAllocatesNothing) {
  open(loopback());
  const test::Bytes bytes(1206);
  sender.send(source->data_port(), bytes);
  ASSERT_EQ(next(), Poll::kPacket);
  for (int i = 0; i < 50; ++i) sender.send(source->data_port(), bytes);
  const std::size_t before = support::allocation_count();
  int received = 0;
  for (int i = 0; i < 50; ++i) received += next() == Poll::kPacket ? 1 : 0;
  EXPECT_EQ(support::allocation_count(), before);
  EXPECT_EQ(received, 50);
}

TEST_F(UdpSourceTest, FeedsTheDecoderLikeACaptureDoes) {
  open(loopback());
  Config config = loopback();
  config.data_port = source->data_port();
  config.position_port = source->position_port();
  Monitor monitor;
  auto lidar = Lidar::create(config, {}, monitor).value();
  test::Sensor sensor;
  Packet sent;
  for (int i = 0; i < 160; ++i) {
    sensor.next(sent);
    sender.send(source->data_port(), sent.bytes);
    ASSERT_EQ(next(), Poll::kPacket);
    EXPECT_EQ(packet.bytes, sent.bytes);
    packet.arrival = sent.arrival;  // this test sends faster than a sensor turns
    EXPECT_TRUE(lidar->decode(packet));
  }
  EXPECT_EQ(lidar->counters().revolutions, 2U);
}

}  // namespace
}  // namespace cairn::velodyne
