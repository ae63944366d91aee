// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/formats/pcap_writer.hpp"

#include <gmock/gmock.h>

#include <random>

#include "drivers/recording/formats/recording.hpp"
#include "drivers/velodyne/transport/pcap_source.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

using velodyne::PcapSource;

constexpr Ipv4 kSensor{192, 168, 1, 201};

std::vector<std::byte> random_bytes(std::size_t n, std::mt19937& random) {
  std::vector<std::byte> bytes(n);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random() & 0xFFU);
  return bytes;
}

/// Sum of the 16-bit words with carry; 0xFFFF when a checksum inside is right (RFC 1071).
std::uint32_t ones_complement_sum(std::string_view bytes) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    sum += static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (i % 2 == 0 ? 8U : 0U);
  while (sum > 0xFFFFU) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return sum;
}

TEST(PcapWriter, WhatIsWrittenIsReadBackExactly) {
  const test::TemporaryFolder folder;
  std::mt19937 random(1);
  auto writer = PcapWriter::create(folder / "f.pcap");
  ASSERT_TRUE(writer);
  struct Sent {
    std::int64_t ns;
    std::uint16_t port;
    std::vector<std::byte> payload;
    bool truncated;
  };
  std::vector<Sent> sent;
  for (int i = 0; i < 2000; ++i) {
    const std::size_t size = i < 100 ? static_cast<std::size_t>(i) : random() % 1300;
    sent.push_back(
        {static_cast<std::int64_t>((std::uint64_t{random()} << 28U | static_cast<std::uint64_t>(i)) % kMaxUtcNs),
         static_cast<std::uint16_t>(random()), random_bytes(size, random), i % 7 == 0});
    ASSERT_TRUE(writer->write(sent.back().ns, kSensor, sent.back().port, sent.back().payload, sent.back().truncated));
  }
  EXPECT_EQ(writer->packets(), sent.size());
  ASSERT_TRUE(writer->close());

  auto reader = PcapSource::open(folder / "f.pcap", {});
  ASSERT_TRUE(reader) << to_string(reader.error());
  Packet packet;
  for (const Sent& s : sent) {
    const auto poll = (*reader)->next(packet, {});
    ASSERT_TRUE(poll && *poll == Poll::kPacket);
    EXPECT_EQ(packet.arrival.time_since_epoch().count(), s.ns);
    EXPECT_EQ(packet.channel, s.port);
    EXPECT_EQ(packet.bytes, s.payload);
    EXPECT_EQ(packet.truncated, s.truncated);
  }
  EXPECT_EQ(*(*reader)->next(packet, {}), Poll::kEnd);
  EXPECT_FALSE((*reader)->counters().truncated_tail);
}

TEST(PcapWriter, HeadersAreThoseOfAnEthernetCapture) {
  const test::TemporaryFolder folder;
  auto writer = PcapWriter::create(folder / "f.pcap");
  ASSERT_TRUE(writer->write(1'700'000'000'123'456'789, kSensor, 2368, test::bytes_of("abc")));
  ASSERT_TRUE(writer->close());
  using namespace std::string_literals;
  EXPECT_EQ(test::slurp(folder / "f.pcap"),
            "\x4D\x3C\xB2\xA1\x02\x00\x04\x00\x00\x00\x00\x00\x00\x00\x00\x00\xFF\xFF\x00\x00\x01\x00\x00\x00"s
            "\x00\xF1\x53\x65\x15\xCD\x5B\x07\x2D\x00\x00\x00\x2D\x00\x00\x00"s
            "\xFF\xFF\xFF\xFF\xFF\xFF\x60\x76\x88\x00\x00\x00\x08\x00"s
            "\x45\x00\x00\x1F\x00\x00\x40\x00\x40\x11\x78\x5D\xC0\xA8\x01\xC9\xFF\xFF\xFF\xFF"s
            "\x09\x40\x09\x40\x00\x0B\x66\x84"s
            "abc"s);
}

TEST(PcapWriter, ChecksumsAreRightForEveryLength) {
  const test::TemporaryFolder folder;
  std::mt19937 random(2);
  auto writer = PcapWriter::create(folder / "f.pcap");
  constexpr std::size_t kLengths = 200;
  for (std::size_t n = 0; n < kLengths; ++n) ASSERT_TRUE(writer->write(0, kSensor, 2368, random_bytes(n, random)));
  ASSERT_TRUE(writer->close());
  const std::string file = test::slurp(folder / "f.pcap");
  std::size_t ip = 24 + 16 + 14;
  for (std::size_t n = 0; n < kLengths; ++n) {
    EXPECT_EQ(ones_complement_sum(file.substr(ip, 20)), 0xFFFFU);
    const std::string pseudo_header = file.substr(ip + 12, 8) + std::string(1, '\0') + "\x11" + file.substr(ip + 24, 2);
    EXPECT_EQ(ones_complement_sum(pseudo_header + file.substr(ip + 20, 8 + n)), 0xFFFFU) << n;
    EXPECT_NE(file.substr(ip + 26, 2), std::string(2, '\0')) << "zero means that there is no checksum";
    ip += 16 + 14 + 20 + 8 + n;
  }
}

TEST(PcapWriter, WhatThePcapFormatCannotHoldIsRefusedAndCostsNothing) {
  const test::TemporaryFolder folder;
  auto writer = PcapWriter::create(folder / "f.pcap");
  ASSERT_TRUE(writer->write(0, kSensor, 2368, test::bytes_of("abc")));
  EXPECT_FALSE(writer->write(-1, kSensor, 2368, {}));
  EXPECT_FALSE(writer->write(kMaxUtcNs + 1, kSensor, 2368, {}));
  EXPECT_FALSE(writer->write(0, kSensor, 2368, std::vector<std::byte>(PcapWriter::kMaxPayload + 1)));
  ASSERT_TRUE(writer->write(0, kSensor, 2368, std::vector<std::byte>(PcapWriter::kMaxPayload)));
  ASSERT_TRUE(writer->close());
  auto reader = PcapSource::open(folder / "f.pcap", {});
  Packet packet;
  while (*(*reader)->next(packet, {}) == Poll::kPacket) continue;
  EXPECT_EQ((*reader)->counters().delivered, 2U);
}

}  // namespace
}  // namespace cairn::recording
