// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/stamp_guard.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cairn::recording {
namespace {

using namespace std::chrono_literals;

/// Hands out one packet for each arrival, numbered from 0.
class Stamped final : public Source {
 public:
  explicit Stamped(std::vector<Time> arrivals) : arrivals_(std::move(arrivals)) {}
  Result<Poll> next(Packet& packet, Duration) override {
    if (next_ == arrivals_.size()) return Poll::kEnd;
    packet.sequence = next_;
    packet.channel = static_cast<std::uint16_t>(next_);
    packet.arrival = arrivals_[next_++];
    return Poll::kPacket;
  }

 private:
  std::vector<Time> arrivals_;
  std::size_t next_ = 0;
};

struct Read {
  std::vector<std::uint16_t> kept;
  std::vector<Error> errors;
};

Read read_all(std::vector<Time> arrivals) {
  GuardedSource source(std::make_unique<Stamped>(std::move(arrivals)), "lidar.pcap", [] { return 1264U; });
  Read read;
  Packet packet;
  for (;;) {
    const auto poll = source.next(packet, {});
    if (!poll)
      read.errors.push_back(poll.error());
    else if (*poll == Poll::kEnd)
      return read;
    else
      read.kept.push_back(packet.channel);
    if (poll && *poll == Poll::kPacket) {
      EXPECT_EQ(packet.sequence + 1, read.kept.size()) << "none is missing";
    }
  }
}

constexpr Time kYear2016{std::chrono::seconds(1'453'364'282)}, kYear2038{std::chrono::seconds(2'147'483'647)};
constexpr Time kYear1970{2s};

std::vector<Time> steady(std::size_t n) {
  std::vector<Time> arrivals;
  for (std::size_t i = 0; i < n; ++i) arrivals.push_back(kYear2016 + static_cast<int>(i) * 1ms);
  return arrivals;
}

TEST(GuardedSource, SetsSingleAbsurdStampsAsideAndNamesThemOnce) {
  auto arrivals = steady(12);
  arrivals[3] = kYear2038;
  arrivals[7] = kYear1970;
  arrivals[8] = kYear2038;
  const Read read = read_all(arrivals);
  EXPECT_EQ(read.kept, (std::vector<std::uint16_t>{0, 1, 2, 4, 5, 6, 9, 10, 11}));
  ASSERT_EQ(read.errors.size(), 1U);
  EXPECT_EQ(read.errors[0].where, "lidar.pcap");
  EXPECT_EQ(read.errors[0].offset, 1264U);
  EXPECT_NE(read.errors[0].detail.find("3 in all, the first is packet 3"), std::string::npos) << read.errors[0].detail;
}

TEST(GuardedSource, FindsThemAtTheBeginningAndAtTheEnd) {
  for (const std::size_t at : {std::size_t{0}, std::size_t{9}})
    for (const Time absurd : {kYear1970, kYear2038}) {
      auto arrivals = steady(10);
      arrivals[at] = absurd;
      const Read read = read_all(arrivals);
      EXPECT_EQ(read.kept.size(), 9U);
      EXPECT_EQ(read.errors.size(), 1U);
    }
}

TEST(GuardedSource, KeepsWhatGoesOnAfterAPauseOrAClockThatWasSet) {
  for (const Duration step : {Duration(30min), Duration(10h), -Duration(48h)}) {
    auto arrivals = steady(10);
    for (std::size_t i = 5; i < 10; ++i) arrivals[i] += step;
    const Read read = read_all(arrivals);
    EXPECT_EQ(read.kept.size(), 10U);
    EXPECT_TRUE(read.errors.empty());
  }
}

TEST(GuardedSource, LeavesShortRecordingsAlone) {
  for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(read_all(steady(n)).kept.size(), n);
  EXPECT_EQ(read_all({kYear1970, kYear2016}).errors.size(), 1U) << "nothing follows the second";
}

}  // namespace
}  // namespace cairn::recording
