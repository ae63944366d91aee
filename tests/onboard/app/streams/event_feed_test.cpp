// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/event_feed.hpp"

#include <gtest/gtest.h>

namespace cairn::app {
namespace {

TEST(EventFeed, TellsEachKindAgainWhenItHappensAgain) {
  Monitor monitor;
  EventFeed feed(monitor);
  EXPECT_TRUE(feed.news().empty());
  monitor.event(Time{Duration{1}}, "odometry", "lost");
  monitor.event(Time{Duration{2}}, "team", "merged");
  EXPECT_EQ(feed.news().size(), 2U);
  EXPECT_TRUE(feed.news().empty());
  monitor.event(Time{Duration{3}}, "odometry", "lost");
  const auto news = feed.news();
  ASSERT_EQ(news.size(), 1U);
  EXPECT_EQ(news[0].stage, "odometry");
  EXPECT_EQ(news[0].what, "lost");
  EXPECT_EQ(news[0].count, 2U);
  EXPECT_EQ(news[0].stamp, Time{Duration{3}});
  EXPECT_EQ(feed.so_far().size(), 2U);
}

TEST(EventFeed, AKindTooManyIsNoNews) {
  Monitor monitor;
  EventFeed feed(monitor);
  for (std::size_t i = 0; i < Monitor::kMaxEvents; ++i) monitor.event({}, "stage", std::to_string(i));
  EXPECT_EQ(feed.news().size(), Monitor::kMaxEvents);
  const std::uint64_t kept = monitor.kept_events();
  monitor.event({}, "stage", "one more");
  EXPECT_EQ(monitor.kept_events(), kept);
  EXPECT_TRUE(feed.news().empty());
}

}  // namespace
}  // namespace cairn::app
