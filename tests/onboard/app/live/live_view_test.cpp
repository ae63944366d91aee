// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/live_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/rounds.hpp"
#include "tests/support/sample_view.hpp"

namespace cairn::app {
namespace {

TEST(LiveView, ParseIsTheInverseOfToLine) {
  const LiveView view = support::sample_view();
  const std::string line = to_line(view);
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
  const auto back = parse_line(line);
  ASSERT_TRUE(back);
  EXPECT_EQ(to_line(*back), line);
  EXPECT_EQ(back->stages[2].dropped, 44U);
  EXPECT_EQ(back->stages[1].p999_ms, 58.1);
  EXPECT_EQ(back->stages[1].deadline_ms, 60);
  EXPECT_EQ(back->stages[1].budget_ms, 40);
  EXPECT_EQ(back->events[1].what, "lidar_late");
  EXPECT_EQ(back->epoch, 2U);
  EXPECT_TRUE(back->peers[0].merged);
  EXPECT_EQ(back->peers[1].state, "no_link");
  EXPECT_EQ(back->peers[1].reason, "no link: not heard for 12 s");
  EXPECT_EQ(back->peers[1].clock_offset_s, -7.5);
}

TEST(LiveView, TellsOfPeopleWhereTheyAreFollowed) {
  LiveView view = support::sample_view();
  EXPECT_FALSE(parse_line(to_line(view))->people);
  view.people = LiveView::People{.now = 2, .tracks = 7, .nearest_m = 1.5};
  const auto back = parse_line(to_line(view));
  ASSERT_TRUE(back && back->people);
  EXPECT_EQ(back->people->now, 2U);
  EXPECT_EQ(back->people->tracks, 7U);
  EXPECT_EQ(back->people->nearest_m, 1.5);
  EXPECT_FALSE(parse_line(R"({"people": 3})")->people);
  EXPECT_EQ(parse_line(R"({"people": {"now": -1, "nearest_m": "near"}})")->people->now, 0U);
}

TEST(LiveView, AnyTextAndAnyNumberMakeOneShortLine) {
  LiveView view = support::sample_view();
  view.robot = "line\nbreak \"\x1b[2J\" \xff\xfe";
  view.rss_mb = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 5000; ++i) {
    view.events.push_back({1.0 * i, std::string(1000, '\x01'), std::string(1000, '"'), 1});
    view.stages.push_back({std::string(400, '\xc3')});
  }
  const std::string line = to_line(view);
  EXPECT_LE(line.size(), LiveView::kMaxLine);
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
  const auto back = parse_line(line);
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->stages.size(), LiveView::kMaxItems);
  ASSERT_FALSE(back->events.empty());
  EXPECT_EQ(back->events.back().t_s, 4999) << "the newest are kept";
}

TEST(LiveView, CutAnywhereItIsAnErrorAndFlippedAnywhereAView) {
  const std::string line = to_line(support::sample_view());
  const std::size_t end = line.size() - 1;  // without its newline it is whole
  for (std::size_t n = 0; n < end; ++n) EXPECT_FALSE(parse_line(line.substr(0, n)));
  std::mt19937 random(1);
  for (int i = 0; i < support::rounds(20'000, 2'000); ++i) {
    std::string damaged = line;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    const auto view = parse_line(damaged);
    if (!view) continue;
    EXPECT_LE(view->stages.size(), LiveView::kMaxItems);
    EXPECT_TRUE(std::isfinite(view->t_s));
    EXPECT_TRUE(parse_line(to_line(*view)));
  }
}

TEST(LiveView, HostileShapesAreRefusedOrIgnored) {
  EXPECT_FALSE(parse_line(""));
  EXPECT_FALSE(parse_line("[]"));
  EXPECT_FALSE(parse_line("{\"t_s\": 1} x"));
  EXPECT_FALSE(parse_line(std::string(LiveView::kMaxLine + 1, ' ')));
  const std::string deep = "{\"stages\":" + std::string(20'000, '[') + std::string(20'000, ']') + "}";
  EXPECT_LE(parse_line(deep).value_or(LiveView{}).stages.size(), 1U);
  const auto odd = parse_line(R"({"t_s":"1","epoch":-3,"scans":1e3,"stages":{"a":1},"events":[1,null,[],{"count":-1}],
    "faults":[1,"a"],"mode":null,"rss_mb":1e999})");
  if (!odd) return;
  EXPECT_EQ(odd->t_s, 0);
  EXPECT_EQ(odd->epoch, 0U);
  EXPECT_TRUE(odd->stages.empty());
  EXPECT_EQ(odd->events.size(), 4U);
  EXPECT_EQ(odd->faults.size(), 2U);
}

}  // namespace
}  // namespace cairn::app
