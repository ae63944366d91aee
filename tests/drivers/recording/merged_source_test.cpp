// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/merged_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>

namespace cairn::recording {
namespace {

/// Hands out what it was given.
class ListSource final : public Source {
 public:
  explicit ListSource(std::vector<Result<Packet>> items) : items_(std::move(items)) {}
  Result<Poll> next(Packet& packet, Duration) override {
    if (next_ == items_.size()) return Poll::kEnd;
    const Result<Packet>& item = items_[next_++];
    if (!item) return item.error();
    packet = *item;
    return Poll::kPacket;
  }

 private:
  std::vector<Result<Packet>> items_;
  std::size_t next_ = 0;
};

/// Has nothing at first and one packet later.
class SlowSource final : public Source {
 public:
  Result<Poll> next(Packet& packet, Duration) override {
    if (calls_++ == 0) return Poll::kTimeout;
    packet = {};
    return calls_ == 2 ? Poll::kPacket : Poll::kEnd;
  }

 private:
  int calls_ = 0;
};

Packet packet_at(std::int64_t ns, std::uint64_t sequence) {
  Packet packet;
  packet.arrival = Time(Duration(ns));
  packet.sequence = sequence;
  packet.bytes.assign(8, static_cast<std::byte>(ns));
  return packet;
}

auto key(const Packet& p) { return std::tuple(p.arrival, p.source, p.sequence); }

using Lists = std::vector<std::vector<Result<Packet>>>;

std::vector<Packet> merge(const Lists& lists, int* errors = nullptr) {
  std::vector<std::unique_ptr<Source>> sources;
  for (const auto& list : lists) sources.push_back(std::make_unique<ListSource>(list));
  MergedSource merged(std::move(sources));
  std::vector<Packet> out;
  Packet packet;
  for (auto poll = merged.next(packet, {}); !poll || *poll != Poll::kEnd; poll = merged.next(packet, {})) {
    if (poll)
      out.push_back(packet);
    else if (errors != nullptr)
      ++*errors;
  }
  return out;
}

TEST(MergedSource, OrderIsThatOfAllPacketsSorted) {
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    Lists lists(random() % 5);
    std::vector<Packet> oracle;
    for (std::size_t s = 0; s < lists.size(); ++s) {
      std::int64_t ns = random() % 10;
      for (std::uint64_t i = 0, n = random() % 30; i < n; ++i) {
        ns += random() % 3;  // many ties, between and within sources
        lists[s].emplace_back(packet_at(ns, i));
        oracle.push_back(*lists[s].back());
        oracle.back().source = static_cast<SourceId>(s);
      }
    }
    std::shuffle(oracle.begin(), oracle.end(), random);
    std::sort(oracle.begin(), oracle.end(), [](const Packet& a, const Packet& b) { return key(a) < key(b); });
    const auto merged = merge(lists);
    ASSERT_EQ(merged.size(), oracle.size());
    for (std::size_t i = 0; i < merged.size(); ++i) {
      ASSERT_EQ(key(merged[i]), key(oracle[i]));
      ASSERT_EQ(merged[i].bytes, oracle[i].bytes);
    }
  }
}

TEST(MergedSource, ASourceOutOfOrderKeepsItsOwnOrder) {
  const auto merged = merge({{packet_at(5, 0), packet_at(1, 1)}, {packet_at(3, 0), packet_at(6, 1)}});
  ASSERT_EQ(merged.size(), 4U);
  std::vector<std::int64_t> order;
  for (const Packet& p : merged) order.push_back(p.arrival.time_since_epoch().count());
  EXPECT_EQ(order, (std::vector<std::int64_t>{3, 5, 1, 6}));
}

TEST(MergedSource, AnErrorOfOneSourceStopsNeitherItNorTheOthers) {
  int errors = 0;
  const Error damage{Errc::kMalformed, "damaged"};
  const auto merged = merge({{packet_at(1, 0), damage, packet_at(4, 1)}, {damage, damage, packet_at(2, 0)}}, &errors);
  EXPECT_EQ(merged.size(), 3U);
  EXPECT_EQ(errors, 3);
}

TEST(MergedSource, WaitsForASourceThatHasNothingYet) {
  std::vector<std::unique_ptr<Source>> sources;
  sources.push_back(std::make_unique<ListSource>(std::vector<Result<Packet>>{packet_at(9, 0)}));
  sources.push_back(std::make_unique<SlowSource>());
  MergedSource merged(std::move(sources));
  Packet packet;
  EXPECT_EQ(*merged.next(packet, {}), Poll::kTimeout);
  EXPECT_EQ(*merged.next(packet, {}), Poll::kPacket);
  EXPECT_EQ(packet.source, SourceId{1}) << "its packet is the earlier one";
  EXPECT_EQ(*merged.next(packet, {}), Poll::kPacket);
  EXPECT_EQ(*merged.next(packet, {}), Poll::kEnd);
}

TEST(MergedSource, NothingIsAtItsEnd) {
  Packet packet;
  EXPECT_EQ(*MergedSource({}).next(packet, {}), Poll::kEnd);
}

}  // namespace
}  // namespace cairn::recording
