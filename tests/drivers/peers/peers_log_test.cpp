// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/peers_log.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "drivers/peers/peer_packet.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::peer_link {
namespace {

std::vector<Packet> sample_packets() {
  std::vector<Packet> packets(4);
  encode(Beginning{3, 12345}, packets[0]);
  for (std::size_t i = 1; i < packets.size(); ++i) packets[i].bytes.assign(400 * i, static_cast<std::byte>(i));
  for (std::size_t i = 0; i < packets.size(); ++i) packets[i].arrival = Time{std::chrono::milliseconds(10 * i)};
  return packets;
}

std::vector<std::byte> log_of(const std::vector<Packet>& packets) {
  std::vector<std::byte> bytes;
  append_log_header(bytes);
  for (const Packet& packet : packets) EXPECT_TRUE(append_log_record(packet, bytes));
  return bytes;
}

class PeersLog : public testing::Test {
 protected:
  Result<std::unique_ptr<PeersLogSource>> open(std::span<const std::byte> bytes) {
    std::ofstream(folder_ / "peers.log", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return PeersLogSource::open(folder_ / "peers.log", SourceId{5});
  }
  support::TemporaryFolder folder_;
};

TEST_F(PeersLog, IsReadAsItWasWritten) {
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
  EXPECT_EQ(decode_beginning(packets[0].bytes), (Beginning{3, 12345}));
}

TEST_F(PeersLog, CutAnywhereItGivesItsWholePacketsAndThenOneError) {
  const auto packets = sample_packets();
  const auto bytes = log_of(packets);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 7) {
    const auto source = open(std::span(bytes).first(cut));
    if (cut < kLogHeaderBytes) {
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

TEST_F(PeersLog, AnyBytesEnd) {
  std::mt19937 random(1);
  const auto good = log_of(sample_packets());
  for (int round = 0; round < 200; ++round) {
    auto bytes = good;
    for (int i = 0; i < 3; ++i)
      bytes[kLogHeaderBytes + random() % (bytes.size() - kLogHeaderBytes)] = static_cast<std::byte>(random());
    const auto source = open(bytes).value();
    Packet packet;
    int polls = 0;
    for (auto poll = source->next(packet, {}); !poll || *poll != Poll::kEnd; poll = source->next(packet, {})) ++polls;
    EXPECT_LT(polls, 200);
  }
}

TEST_F(PeersLog, RefusesWhatItIsNot) {
  EXPECT_FALSE(PeersLogSource::open(folder_ / "none", SourceId{}));
  std::vector<std::byte> bytes = log_of({});
  bytes[4] = std::byte{2};
  EXPECT_EQ(open(bytes).error().code, Errc::kUnsupported);
  bytes[0] = std::byte{0};
  EXPECT_EQ(open(bytes).error().code, Errc::kMalformed);
  Packet long_one;
  long_one.bytes.resize(kMaxPacket + 1);
  EXPECT_FALSE(append_log_record(long_one, bytes));
}

TEST(Beginning, OfNobodyOrOfAnotherLengthIsNone) {
  EXPECT_FALSE(decode_beginning(std::vector<std::byte>(16)));
  EXPECT_FALSE(decode_beginning(std::vector<std::byte>(15, std::byte{1})));
}

}  // namespace
}  // namespace cairn::peer_link
