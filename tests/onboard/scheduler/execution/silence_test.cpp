// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/silence.hpp"

#include <gtest/gtest.h>

#include "onboard/scheduler/execution/executive.hpp"
#include "onboard/scheduler/feed.hpp"
#include "tests/onboard/scheduler/list_source.hpp"

namespace cairn::scheduler {
namespace {

using namespace std::chrono_literals;

/// Notes when each packet was taken.
struct Taker final : Task {
  explicit Taker(Source& source) : feed(source, SourceId{0}, take_slots(), [](Time, const Error&) {}) {}
  void tick(Tick& tick) override {
    ++ticks;
    while (feed.take(tick) != nullptr) taken.push_back(tick.release());
    if (feed.ended()) tick.end_of_input();
  }
  Feed feed;
  std::vector<Time> taken;
  std::uint64_t ticks = 0;
};

struct Replayed {
  std::vector<Time> taken;
  std::uint64_t ticks = 0;
  Duration jumped{};
};

Replayed replay(std::vector<Time> arrivals, bool jumps) {
  test::ListSource source(std::move(arrivals));
  Taker taker(source);
  TaskGraph graph;
  graph.add({.name = "taker", .rate_hz = 100}, taker, TaskRole::kInput);
  Executive executive(graph);
  ReplayOptions options;
  if (jumps) options.next_arrival = [&taker] { return taker.feed.first_arrival(); };
  const auto end = executive.run_replay(options);
  EXPECT_TRUE(end);
  return {taker.taken, taker.ticks, end ? end->jumped : Duration{}};
}

TEST(Silence, OfYearsIsPassedInAMoment) {
  const Time late{std::chrono::hours(24 * 365 * 22)};
  const Replayed run = replay({Time{5ms}, late, late + 1s}, true);
  EXPECT_EQ(run.taken, (std::vector{Time{10ms}, late, late + 1s}));
  EXPECT_LT(run.ticks, 10'000U);
  EXPECT_GT(run.jumped, std::chrono::hours(24 * 365 * 21));
}

TEST(Silence, ThatIsShortIsWalkedTickByTick) {
  const std::vector<Time> arrivals{Time{5ms}, Time{80s}, Time{81s}};
  const Replayed run = replay(arrivals, true), walked = replay(arrivals, false);
  EXPECT_EQ(run.jumped, Duration{});
  EXPECT_EQ(run.ticks, walked.ticks);
  EXPECT_EQ(run.taken, walked.taken);
}

TEST(Silence, IsPassedToTheSameReleasesAsWalking) {
  const std::vector<Time> arrivals{Time{5ms}, Time{200s} + 3ms, Time{400s} + 7ms};
  const Replayed run = replay(arrivals, true), walked = replay(arrivals, false);
  EXPECT_GT(run.jumped, 200s);
  EXPECT_LT(run.ticks, walked.ticks);
  EXPECT_EQ(run.taken, walked.taken);
}

}  // namespace
}  // namespace cairn::scheduler
