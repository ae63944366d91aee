// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/faulty_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

namespace cairn::recording {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t kPackets = 10'000;

/// A packet each millisecond from two sources in turn, its bytes its number.
class Numbers final : public Source {
 public:
  Result<Poll> next(Packet& packet, Duration) override {
    if (n_ == kPackets) return Poll::kEnd;
    packet.source = static_cast<SourceId>(n_ % 2);
    packet.sequence = n_ / 2;
    packet.arrival = Time(std::chrono::milliseconds(n_));
    packet.truncated = false;
    packet.bytes.assign(16, static_cast<std::byte>(n_ % 251));
    ++n_;
    return Poll::kPacket;
  }

 private:
  std::uint64_t n_ = 0;
};

struct Arrived {
  std::vector<Packet> packets;
  FaultySource::Counters counters;
};

Arrived arrive(const Faults& faults) {
  Numbers numbers;
  FaultySource source(numbers, faults);
  Arrived all;
  Packet packet;
  while (source.next(packet, {}).value() == Poll::kPacket) all.packets.push_back(packet);
  all.counters = source.counters();
  return all;
}

bool is_damaged(const Packet& p) {
  const auto n = 2 * p.sequence + static_cast<std::uint64_t>(p.source);
  return p.bytes.size() != 16 ||
         std::any_of(p.bytes.begin(), p.bytes.end(), [&](std::byte b) { return b != static_cast<std::byte>(n % 251); });
}

TEST(FaultySource, WithoutFaultsEverythingArrivesAsItIs) {
  const auto all = arrive({});
  ASSERT_EQ(all.packets.size(), kPackets);
  EXPECT_TRUE(std::is_sorted(all.packets.begin(), all.packets.end(),
                             [](const Packet& a, const Packet& b) { return a.arrival < b.arrival; }));
  EXPECT_TRUE(std::none_of(all.packets.begin(), all.packets.end(), is_damaged));
}

TEST(FaultySource, EachFaultHasItsShareAndIsCounted) {
  Faults faults;
  faults.drop = 0.1;
  EXPECT_NEAR(static_cast<double>(arrive(faults).packets.size()), 9000, 150);
  faults = {};
  faults.repeat = 0.1;
  EXPECT_NEAR(static_cast<double>(arrive(faults).packets.size()), 11'000, 150);
  faults = {};
  faults.cut = 0.1;
  auto all = arrive(faults);
  EXPECT_NEAR(static_cast<double>(all.counters.cut), 1000, 150);
  EXPECT_EQ(std::count_if(all.packets.begin(), all.packets.end(), [](const Packet& p) { return p.truncated; }),
            static_cast<std::ptrdiff_t>(all.counters.cut));
  faults = {};
  faults.flip = 0.1;
  all = arrive(faults);
  EXPECT_EQ(std::count_if(all.packets.begin(), all.packets.end(), is_damaged),
            static_cast<std::ptrdiff_t>(all.counters.flipped));
}

TEST(FaultySource, SwappedPacketsComeLateButCome) {
  Faults faults;
  faults.swap = 0.2;
  const auto all = arrive(faults);
  EXPECT_EQ(all.packets.size(), kPackets);
  EXPECT_GT(all.counters.swapped, 1000U);
  std::uint64_t backwards = 0;
  for (std::size_t i = 1; i < all.packets.size(); ++i)
    backwards += all.packets[i].arrival < all.packets[i - 1].arrival ? 1 : 0;
  EXPECT_GE(backwards, all.counters.swapped / 2);
}

TEST(FaultySource, AFreezeIsSilenceOfItsLength) {
  Faults faults;
  faults.freeze = 200ms;
  faults.period = 1s;
  const auto all = arrive(faults);
  EXPECT_EQ(all.counters.frozen, kPackets / 5);
  EXPECT_EQ(all.packets.front().arrival, Time{});
  Duration longest{};
  for (std::size_t i = 1; i < all.packets.size(); ++i)
    longest = std::max<Duration>(longest, all.packets[i].arrival - all.packets[i - 1].arrival);
  EXPECT_EQ(longest, 201ms);
}

TEST(FaultySource, TheOtherSourcesAreLeftAlone) {
  Faults faults;
  faults.drop = faults.flip = 0.5;
  faults.only = SourceId{1};
  const auto all = arrive(faults);
  std::uint64_t first = 0;
  for (const Packet& p : all.packets) {
    first += p.source == SourceId{0} ? 1 : 0;
    EXPECT_TRUE(p.source != SourceId{0} || !is_damaged(p));
  }
  EXPECT_EQ(first, kPackets / 2);
}

TEST(FaultySource, TheSameSeedGivesTheSameFaults) {
  Faults faults;
  faults.drop = faults.repeat = faults.swap = faults.cut = faults.flip = 0.1;
  const auto a = arrive(faults), b = arrive(faults);
  ASSERT_EQ(a.packets.size(), b.packets.size());
  for (std::size_t i = 0; i < a.packets.size(); ++i) ASSERT_EQ(a.packets[i].bytes, b.packets[i].bytes);
  faults.seed = 2;
  EXPECT_NE(arrive(faults).counters.dropped, a.counters.dropped);
}

TEST(FaultySource, AddedBytesAreAddedAtTheEnd) {
  Faults faults;
  faults.extend = 0.1;
  const auto all = arrive(faults);
  std::uint64_t longer = 0;
  for (const Packet& p : all.packets) {
    longer += p.bytes.size() > 16 ? 1U : 0U;
    EXPECT_LE(p.bytes.size(), 16U + 64U);
    EXPECT_FALSE(p.truncated);
  }
  EXPECT_EQ(longer, all.counters.extended);
  EXPECT_NEAR(static_cast<double>(longer), 1000, 150);
}

TEST(FaultySource, DelayedPacketsComeInTheOrderOfTheirNewArrival) {
  Faults faults;
  faults.delay = 0.2;
  faults.delay_by = 7ms;
  const auto all = arrive(faults);
  ASSERT_EQ(all.packets.size(), kPackets);
  EXPECT_TRUE(std::is_sorted(all.packets.begin(), all.packets.end(),
                             [](const Packet& a, const Packet& b) { return a.arrival < b.arrival; }));
  EXPECT_NEAR(static_cast<double>(all.counters.delayed), 2000, 200);
}

TEST(FaultySource, ASpellOfBurstsKeepsEverythingAndHandsItOverAtOnce) {
  Faults faults;
  faults.spell = Spell::kBurst;
  faults.freeze = 100ms;
  faults.period = 1s;
  const auto all = arrive(faults);
  ASSERT_EQ(all.packets.size(), kPackets);
  EXPECT_EQ(all.counters.burst, 1000U);
  const auto at_once =
      std::count_if(all.packets.begin(), all.packets.end(), [](const Packet& p) { return p.arrival == Time{1s}; });
  EXPECT_EQ(at_once, 101);
}

TEST(FaultySource, AStuckSourceRepeatsItsLastGoodBytes) {
  Faults faults;
  faults.spell = Spell::kStuck;
  faults.freeze = 100ms;
  faults.period = 1s;
  const auto all = arrive(faults);
  ASSERT_EQ(all.packets.size(), kPackets);
  EXPECT_EQ(all.counters.stuck, 1000U);
  for (std::size_t i = 900; i < 1000; ++i) EXPECT_EQ(all.packets[i].bytes, all.packets[899].bytes);
  EXPECT_NE(all.packets[1000].bytes, all.packets[899].bytes);
}

TEST(FaultySource, ADisconnectIsSaidOnceAndThenSilent) {
  Numbers numbers;
  Faults faults;
  faults.spell = Spell::kDisconnect;
  faults.freeze = 100ms;
  faults.period = 1s;
  FaultySource source(numbers, faults);
  Packet packet;
  int errors = 0, packets = 0;
  for (auto poll = source.next(packet, {}); !poll || *poll != Poll::kEnd; poll = source.next(packet, {})) {
    errors += poll ? 0 : 1;
    packets += poll ? 1 : 0;
    EXPECT_TRUE(poll || poll.error().code == Errc::kLinkDown);
  }
  EXPECT_EQ(errors, 10);
  EXPECT_EQ(packets, 9000);
}

TEST(FaultySource, AShiftMovesTheStampsFromItsTimeOn) {
  Faults faults;
  faults.shift = -3s;
  faults.shift_after = 5s;
  const auto all = arrive(faults);
  EXPECT_EQ(all.packets[4999].arrival, Time{4999ms});
  EXPECT_EQ(all.packets[5000].arrival, Time{2000ms});
  EXPECT_EQ(all.counters.shifted, 5000U);
}

}  // namespace
}  // namespace cairn::recording
