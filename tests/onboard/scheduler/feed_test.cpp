// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/feed.hpp"

#include <gtest/gtest.h>

#include "tests/onboard/scheduler/list_source.hpp"

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;
using test::ListSource;

struct FeedTest : ::testing::Test {
  /// How many packets a tick of the regime gets.
  int take(Regime regime, Time release, std::int32_t logged = 0) {
    record = {};
    record.index = index++;
    record.slots[2] = logged;
    Tick tick(regime, release, record);
    int n = 0;
    while (feed.take(tick) != nullptr) ++n;
    return n;
  }

  ListSource source{{Time{1ms}, Time{2ms}, Time{2ms}, Time{9ms}}};
  Feed feed{source, SourceId{3}, 2, [this](Time, const Error&) { ++complaints; }, [this](const Packet&) { ++tapped; }};
  TickRecord record;
  std::uint64_t index = 0;
  int complaints = 0, tapped = 0;
};

TEST_F(FeedTest, InVirtualTimeATickGetsWhatArrivedUpToItsRelease) {
  EXPECT_TRUE(feed.first_arrival() == Time{1ms});
  EXPECT_EQ(take(Regime::kVirtual, Time{1ms} - 1ns), 0);
  EXPECT_EQ(take(Regime::kVirtual, Time{2ms}), 3);
  EXPECT_FALSE(feed.ended());
  EXPECT_EQ(take(Regime::kVirtual, Time{20ms}), 1);
  EXPECT_TRUE(feed.ended());
  EXPECT_EQ(tapped, 4);
}

TEST_F(FeedTest, LiveTakesWhatThereIsAndNotesHowMuch) {
  source.set_limit(3);
  EXPECT_EQ(take(Regime::kLive, Time{0ms}), 3);
  EXPECT_EQ(record.slots[2], 3);
  EXPECT_EQ(take(Regime::kLive, Time{0ms}), 0);
  EXPECT_TRUE(record.idle());
}

TEST_F(FeedTest, ALogGivesAsManyAsThenAndSaysWhatIsMissing) {
  EXPECT_EQ(take(Regime::kLogged, Time{0ms}, 2), 2);
  EXPECT_EQ(take(Regime::kLogged, Time{0ms}, 0), 0);
  EXPECT_EQ(take(Regime::kLogged, Time{0ms}, 5), 2);
  EXPECT_EQ(feed.missing(), 3U);
}

TEST_F(FeedTest, ASourceThatComplainsIsHeardAndAskedAgain) {
  source.complain(2);
  EXPECT_EQ(take(Regime::kVirtual, Time{1ms}), 1);
  EXPECT_EQ(complaints, 2);
}

}  // namespace
}  // namespace cairn::scheduler
