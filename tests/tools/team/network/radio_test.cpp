// SPDX-License-Identifier: Apache-2.0
#include "tools/team/network/radio.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace cairn::team_run {
namespace {

using std::chrono::milliseconds;

const LinkConfig kClean{0, 300, 0, 0, 0, 0, 0, 1};

bool operator==(const Fate& a, const Fate& b) {
  return std::tie(a.lost, a.twice, a.delay) == std::tie(b.lost, b.twice, b.delay);
}

std::vector<std::byte> numbered(std::size_t n, std::size_t size = 100) {
  std::vector<std::byte> bytes(size);
  bytes[0] = static_cast<std::byte>(n);
  bytes[1] = static_cast<std::byte>(n >> 8U);
  return bytes;
}
std::size_t number_of(const Radio::Packet& packet) {
  return std::to_integer<std::size_t>(packet.bytes[0]) | std::to_integer<std::size_t>(packet.bytes[1]) << 8U;
}

/// (when, from, to, number) of every arrival of `count` packets that robot 0 sends to robot 1 every millisecond.
std::vector<std::tuple<Time, Index, Index, std::size_t>> arrivals(const LinkConfig& link, std::size_t count,
                                                                  bool others_send_too = false) {
  Radio radio(link, 3);
  std::vector<std::tuple<Time, Index, Index, std::size_t>> seen;
  std::vector<Radio::Packet> out;
  for (std::size_t i = 0; i < count + 20'000; ++i) {
    const Time now{milliseconds(i)};
    if (i < count) radio.offer(0, 1, numbered(i), now);
    if (i < count && others_send_too) radio.offer(2, 1, numbered(i), now);
    out.clear();
    radio.arrived(now, out);
    for (const auto& p : out)
      if (p.from == 0) seen.emplace_back(now, p.from, p.to, number_of(p));
  }
  return seen;
}

TEST(Fate, IsAFunctionOfSeedPairAndNumber) {
  const LinkConfig link;
  LinkConfig other_seed;
  other_seed.seed = 2;
  int as_other_seed = 0, as_other_way = 0;
  for (std::uint64_t n = 0; n < 1000; ++n) {
    EXPECT_TRUE(fate_of(link, 0, 1, n) == fate_of(link, 0, 1, n));
    as_other_seed += fate_of(link, 0, 1, n) == fate_of(other_seed, 0, 1, n) ? 1 : 0;
    as_other_way += fate_of(link, 0, 1, n) == fate_of(link, 1, 0, n) ? 1 : 0;
  }
  EXPECT_LT(as_other_seed, 10);
  EXPECT_LT(as_other_way, 10);
}

TEST(Fate, SharesAreThoseOfTheLink) {
  LinkConfig link;
  link.reorder = 0.1;
  constexpr int kPackets = 20'000;
  int lost = 0, twice = 0, at_once = 0;
  Duration sum{};
  for (std::uint64_t n = 0; n < kPackets; ++n) {
    const Fate fate = fate_of(link, 1, 0, n);
    lost += fate.lost ? 1 : 0;
    twice += fate.twice ? 1 : 0;
    at_once += fate.delay[0] == Duration{} ? 1 : 0;
    sum += fate.delay[0];
    EXPECT_LE(fate.delay[0], milliseconds(150));
  }
  // Five standard deviations of a binomial share around each.
  const auto near = [](int count, double share) {
    return std::abs(count - share * kPackets) < 5 * std::sqrt(share * (1 - share) * kPackets);
  };
  EXPECT_TRUE(near(lost, 0.2)) << lost;
  EXPECT_TRUE(near(twice, 0.05)) << twice;
  EXPECT_TRUE(near(at_once, 0.1 + 0.9 * 0.25)) << at_once;  // a quarter of 50 ± 100 ms is below 0
  EXPECT_NEAR(to_milliseconds(sum) / kPackets, 0.9 * (150.0 * 150 / 2) / 200, 1);
}

TEST(Radio, SameSeedSameArrivalsWhateverOthersSend) {
  LinkConfig link;
  link.rate_bit_s = 0;
  const auto alone = arrivals(link, 500);
  EXPECT_EQ(alone, arrivals(link, 500));
  EXPECT_EQ(alone, arrivals(link, 500, true));
  link.seed = 2;
  EXPECT_NE(alone, arrivals(link, 500));
}

TEST(Radio, ACleanLinkHandsOverEverythingAtOnceAndInOrder) {
  const auto seen = arrivals(kClean, 500);
  ASSERT_EQ(seen.size(), 500U);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], std::tuple(Time{milliseconds(i)}, 0U, 1U, i));
}

TEST(Radio, JitterReordersAndDuplicatesComeTwice) {
  LinkConfig link = kClean;
  link.delay_ms = 50, link.jitter_ms = 40, link.duplicate = 0.3;
  const auto seen = arrivals(link, 1000);
  std::multiset<std::size_t> numbers;
  std::vector<std::size_t> order;
  for (const auto& arrival : seen) {
    numbers.insert(std::get<3>(arrival));
    order.push_back(std::get<3>(arrival));
  }
  std::size_t doubled = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    ASSERT_TRUE(numbers.count(i) == 1 || numbers.count(i) == 2) << i;
    doubled += numbers.count(i) - 1;
  }
  EXPECT_GT(doubled, 200U);
  EXPECT_FALSE(std::ranges::is_sorted(order));
}

TEST(Radio, NoMoreThanTheRateArrives) {
  LinkConfig link = kClean;
  link.rate_bit_s = 80'000;  // a packet of 100 bytes takes 10 ms, and ten times as many are sent
  const auto seen = arrivals(link, 1000);
  EXPECT_NEAR(static_cast<double>(seen.size()), 100 + 30, 2);  // those of the time, and the queue's
  for (std::size_t i = 1; i < seen.size(); ++i)
    EXPECT_GE(std::get<0>(seen[i]) - std::get<0>(seen[i - 1]), milliseconds(10));
}

TEST(Radio, CountsWhatBecameOfEveryPacket) {
  LinkConfig link;
  link.rate_bit_s = 400'000;
  Radio radio(link, 2);
  for (std::size_t i = 0; i < 1000; ++i) radio.offer(0, 1, numbered(i), Time{milliseconds(i)});
  std::vector<Radio::Packet> out;
  radio.arrived(Time{std::chrono::hours(1)}, out);
  const auto& sent = radio.counters(0);
  const auto& heard = radio.counters(1);
  EXPECT_EQ(sent.tx_packets, 1000U);
  EXPECT_EQ(sent.tx_bytes, 100'000U);
  EXPECT_GT(sent.queue_full, 0U);
  EXPECT_EQ(heard.rx_packets, sent.tx_packets - sent.queue_full - sent.lost + sent.doubled);
  EXPECT_EQ(heard.rx_bytes, 100 * heard.rx_packets);
  EXPECT_EQ(out.size(), heard.rx_packets);
  EXPECT_FALSE(radio.next());
}

TEST(Radio, SaysWhenTheNextPacketArrives) {
  LinkConfig link = kClean;
  link.delay_ms = 30;
  Radio radio(link, 2);
  EXPECT_FALSE(radio.next());
  radio.offer(0, 1, numbered(1), Time{milliseconds(5)});
  ASSERT_EQ(radio.next(), Time{milliseconds(35)});
  std::vector<Radio::Packet> out;
  radio.arrived(Time{milliseconds(34)}, out);
  EXPECT_TRUE(out.empty());
  radio.arrived(Time{milliseconds(37)}, out);
  EXPECT_EQ(out.size(), 1U);
  EXPECT_EQ(radio.most_late(), milliseconds(2));
}

}  // namespace
}  // namespace cairn::team_run
