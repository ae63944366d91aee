// SPDX-License-Identifier: Apache-2.0
#include "hal/files/packet_log.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "tests/support/temporary_folder.hpp"

namespace cairn {
namespace {

constexpr PacketLogFormat kFormat{.magic = 0x4C525043, .most_bytes = 1200, .contents = "what peers sent"};

std::vector<Packet> sample_packets() {
  std::vector<Packet> packets(4);
  packets[0].channel = 1;
  for (std::size_t i = 1; i < packets.size(); ++i) packets[i].bytes.assign(400 * i, static_cast<std::byte>(i));
  for (std::size_t i = 0; i < packets.size(); ++i) packets[i].arrival = Time{std::chrono::milliseconds(10 * i)};
  return packets;
}

std::vector<std::byte> log_of(const std::vector<Packet>& packets) {
  std::vector<std::byte> bytes;
  append_log_header(kFormat, bytes);
  for (const Packet& packet : packets) EXPECT_TRUE(append_log_record(kFormat, packet, bytes));
  return bytes;
}

class PacketLog : public testing::Test {
 protected:
  Result<std::unique_ptr<PacketLogSource>> open(std::span<const std::byte> bytes) {
    std::ofstream(folder_ / "packets.log", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return PacketLogSource::open(folder_ / "packets.log", kFormat, SourceId{5});
  }
  support::TemporaryFolder folder_;
};

TEST_F(PacketLog, IsReadAsItWasWritten) {
  const auto packets = sample_packets();
  const auto source = open(log_of(packets)).value();
  Packet packet;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    ASSERT_EQ(source->next(packet, {}).value(), Poll::kPacket);
    EXPECT_EQ(packet.bytes, packets[i].bytes);
    EXPECT_EQ(packet.channel, packets[i].channel);
    EXPECT_EQ(packet.arrival, packets[i].arrival);
    EXPECT_EQ(packet.source, SourceId{5});
    EXPECT_EQ(packet.sequence, i);
  }
  EXPECT_EQ(source->next(packet, {}).value(), Poll::kEnd);
}

TEST_F(PacketLog, CutAnywhereItGivesItsWholePacketsAndThenOneError) {
  const auto packets = sample_packets();
  const auto bytes = log_of(packets);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 7) {
    const auto source = open(std::span(bytes).first(cut));
    if (cut < kPacketLogHeaderBytes) {
      EXPECT_FALSE(source);
      continue;
    }
    Packet packet;
    std::size_t whole = 0, errors = 0;
    for (auto poll = (*source)->next(packet, {}); !poll || *poll != Poll::kEnd; poll = (*source)->next(packet, {}))
      ++(poll ? whole : errors);
    EXPECT_LT(whole, packets.size());
    EXPECT_LE(errors, 1U);
  }
}

TEST_F(PacketLog, AnyBytesEnd) {
  std::mt19937 random(1);
  const auto good = log_of(sample_packets());
  for (int round = 0; round < 200; ++round) {
    auto bytes = good;
    for (int i = 0; i < 3; ++i)
      bytes[kPacketLogHeaderBytes + random() % (bytes.size() - kPacketLogHeaderBytes)] =
          static_cast<std::byte>(random());
    const auto source = open(bytes).value();
    Packet packet;
    int polls = 0;
    for (auto poll = source->next(packet, {}); !poll || *poll != Poll::kEnd; poll = source->next(packet, {})) ++polls;
    EXPECT_LT(polls, 200);
  }
}

TEST_F(PacketLog, RefusesWhatItIsNot) {
  EXPECT_FALSE(PacketLogSource::open(folder_ / "none", kFormat, SourceId{}));
  std::vector<std::byte> bytes = log_of({});
  bytes[4] = std::byte{2};
  EXPECT_EQ(open(bytes).error().code, Errc::kUnsupported);
  bytes[0] = std::byte{0};
  EXPECT_EQ(open(bytes).error().code, Errc::kMalformed);
  Packet long_one;
  long_one.bytes.resize(kFormat.most_bytes + 1);
  EXPECT_FALSE(append_log_record(kFormat, long_one, bytes));
}

}  // namespace
}  // namespace cairn
