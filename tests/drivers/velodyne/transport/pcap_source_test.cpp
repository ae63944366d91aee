// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/transport/pcap_source.hpp"

#include <gtest/gtest.h>

#include "drivers/velodyne/lidar.hpp"
#include "drivers/velodyne/transport/frame.hpp"
#include "hal/files/file.hpp"
#include "tests/support/velodyne_encoder.hpp"
#include "tests/support/velodyne_frames.hpp"

namespace cairn::velodyne {
namespace {

using test::Bytes;
using test::Capture;
using test::ethernet;
using test::ipv4;
using test::Udp;

/// A source over bytes in memory.
Result<std::unique_ptr<PcapSource>> source_of(Bytes& bytes, const PcapSource::Options& options = {}) {
  std::FILE* file = fmemopen(bytes.data(), bytes.size(), "rb");
  return PcapSource::from_stream(file, "test.pcap", options);
}

Udp datagram(std::size_t size, std::uint16_t port = 2368) {
  Udp udp;
  udp.payload.resize(size, std::byte{0x5A});
  udp.destination_port = port;
  return udp;
}

std::vector<Packet> all(PcapSource& source) {
  std::vector<Packet> out;
  Packet packet;
  for (;;) {
    const auto poll = source.next(packet, {});
    if (!poll || *poll == Poll::kEnd) return out;
    if (*poll == Poll::kPacket) out.push_back(packet);
  }
}

TEST(PcapSource, DeliversWhatWasCapturedWithNanoseconds) {
  Capture capture(kLinkEthernet);
  capture.add(1000, 123'456'789, ethernet(ipv4(datagram(1206))));
  capture.add(1000, 999'999'999, ethernet(ipv4(datagram(512, 8308)), {0x8100}));
  PcapSource::Options options;
  options.source = SourceId{4};
  auto source = source_of(capture.bytes, options).value();
  const auto packets = all(*source);
  ASSERT_EQ(packets.size(), 2U);
  EXPECT_EQ(packets[0].arrival, Time{Duration{1'000'123'456'789}});
  EXPECT_EQ(packets[0].channel, 2368);
  EXPECT_EQ(packets[0].bytes.size(), 1206U);
  EXPECT_EQ(packets[0].source, SourceId{4});
  EXPECT_EQ(packets[0].sequence, 0U);
  EXPECT_EQ(packets[1].arrival, Time{Duration{1'000'999'999'999}});
  EXPECT_EQ(packets[1].channel, 8308);
  EXPECT_EQ(packets[1].sequence, 1U);
  Packet packet;
  EXPECT_EQ(source->next(packet, {}).value(), Poll::kEnd) << "and again";
}

TEST(PcapSource, MicrosecondFilesToo) {
  Capture capture(kLinkSll, false);
  capture.add(7, 999'999, test::sll(ipv4(datagram(1206))));
  EXPECT_EQ(all(*source_of(capture.bytes).value()).at(0).arrival, Time{Duration{7'999'999'000}});
}

TEST(PcapSource, ReadsPcapng) {
  test::CaptureNg capture(kLinkEthernet);
  capture.add(1'453'364'282'708'714'123, ethernet(ipv4(datagram(1206))));
  const auto packets = all(*source_of(capture.bytes).value());
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(packets[0].arrival, Time{Duration{1'453'364'282'708'714'123}});
}

TEST(PcapSource, FiltersPortsAndSendersAndSkipsForeignTraffic) {
  Capture capture(kLinkEthernet);
  Udp other = datagram(1206);
  other.source = 0x01020304;
  capture.add(1, 0, ethernet(ipv4(datagram(1206))));
  capture.add(2, 0, ethernet(ipv4(other)));
  capture.add(3, 0, ethernet(ipv4(datagram(100, 53))));
  capture.add(4, 0, ethernet(ipv4(datagram(1206)), {}, 0x86DD));
  Udp broken = datagram(10);
  broken.length_error = 5;
  capture.add(5, 0, ethernet(ipv4(broken)));
  capture.add(6, 0, ethernet(ipv4(datagram(512, 8308))));
  PcapSource::Options options;
  options.ports = {2368, 8308};
  options.source_address = 0xC0A801C9;
  auto source = source_of(capture.bytes, options).value();
  const auto packets = all(*source);
  ASSERT_EQ(packets.size(), 2U);
  EXPECT_EQ(to_seconds(packets[0].arrival), 1);
  EXPECT_EQ(to_seconds(packets[1].arrival), 6);
  EXPECT_EQ(source->counters().records, 6U);
  EXPECT_EQ(source->counters().filtered, 2U);
  EXPECT_EQ(source->counters().foreign, 1U);
  EXPECT_EQ(source->counters().malformed, 1U);
}

TEST(PcapSource, ShortCaptureLengthMarksThePacket) {
  Capture capture(kLinkEthernet);
  capture.add(1, 0, ethernet(ipv4(datagram(1206))), 96);
  capture.add(2, 0, ethernet(ipv4(datagram(1206))), 20);
  auto source = source_of(capture.bytes).value();
  const auto packets = all(*source);
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_TRUE(packets[0].truncated);
  EXPECT_EQ(packets[0].bytes.size(), 96U - 42U);
  EXPECT_EQ(source->counters().malformed, 1U);
}

// A file may end anywhere: what was whole before is delivered, and the end is no error.
TEST(PcapSource, TruncatedFileEndsCleanly) {
  Capture capture(kLinkEthernet);
  for (std::uint32_t i = 0; i < 3; ++i) capture.add(i, 0, ethernet(ipv4(datagram(64))));
  const std::size_t record = (capture.bytes.size() - 24) / 3;
  for (std::size_t n = 24; n < capture.bytes.size(); ++n) {
    Bytes cut(capture.bytes.begin(), capture.bytes.begin() + static_cast<std::ptrdiff_t>(n));
    auto source = source_of(cut).value();
    Packet packet;
    std::size_t whole = 0;
    Result<Poll> poll = Poll::kTimeout;
    while ((poll = source->next(packet, {})) && *poll == Poll::kPacket) ++whole;
    ASSERT_TRUE(poll.has_value()) << n << to_string(poll.error());
    EXPECT_EQ(whole, (n - 24) / record);
    EXPECT_EQ(source->counters().truncated_tail, (n - 24) % record != 0) << n;
  }
}

TEST(PcapSource, DamagedRecordIsOneErrorWithItsPlace) {
  Capture capture(kLinkEthernet);
  capture.add(1, 0, ethernet(ipv4(datagram(64))));
  const std::size_t second = capture.bytes.size();
  capture.add(2, 0, ethernet(ipv4(datagram(64))));
  test::store_le(capture.bytes, second + 8, std::uint32_t{0x7FFFFFFF});  // caplen
  auto source = source_of(capture.bytes).value();
  Packet packet;
  EXPECT_EQ(source->next(packet, {}).value(), Poll::kPacket);
  const auto damaged = source->next(packet, {});
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().where, "test.pcap");
  EXPECT_EQ(damaged.error().offset, second + 16);
  EXPECT_EQ(source->next(packet, {}).value(), Poll::kEnd);
}

TEST(PcapSource, WhatIsNoCaptureIsRefused) {
  Bytes text(100, std::byte{'x'});
  const auto source = source_of(text);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Errc::kMalformed);
  EXPECT_EQ(source.error().where, "test.pcap");
  Capture wifi(105);
  EXPECT_EQ(source_of(wifi.bytes).error().code, Errc::kUnsupported);
  EXPECT_EQ(PcapSource::open("/nonexistent/a.pcap", {}).error().code, Errc::kNotFound);
}

TEST(PcapSource, SkippingIsBounded) {
  Capture capture(kLinkEthernet);
  for (int i = 0; i < PcapSource::kMaxSkipped + 1; ++i) capture.add(1, 0, ethernet({}, {}, 0x0806));
  capture.add(2, 0, ethernet(ipv4(datagram(8))));
  auto source = source_of(capture.bytes).value();
  Packet packet;
  EXPECT_EQ(source->next(packet, {}).value(), Poll::kTimeout);
  EXPECT_EQ(source->next(packet, {}).value(), Poll::kPacket);
}

TEST(PcapSource, FeedsTheDecoder) {
  test::Sensor sensor;
  Capture capture(kLinkSll2);
  for (int i = 0; i < 200; ++i) {
    const Packet p = sensor.next();
    const auto ns = p.arrival.time_since_epoch().count();
    Udp udp = datagram(0);
    udp.payload = p.bytes;
    capture.add(static_cast<std::uint32_t>(ns / 1'000'000'000), static_cast<std::uint32_t>(ns % 1'000'000'000),
                test::sll2(ipv4(udp)));
  }
  Monitor monitor;
  auto lidar = Lidar::create({}, {}, monitor).value();
  auto source = source_of(capture.bytes).value();
  for (const Packet& p : all(*source)) EXPECT_TRUE(lidar->decode(p));
  EXPECT_EQ(lidar->counters().revolutions, 2U);
  EXPECT_EQ(lidar->counters().lost_packets, 0U);
}

}  // namespace
}  // namespace cairn::velodyne
