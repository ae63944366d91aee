// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/top/render.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "tests/support/sample_view.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

std::string text(const app::LiveView& view, const Screen& screen = {120, 40, false}) {
  std::string all;
  for (const std::string& line : render(view, screen)) all += line + "\n";
  return all;
}

TEST(RenderTop, ShowsTasksAgainstTheirDeadlines) {
  const std::string shown = text(support::sample_view());
  EXPECT_EQ(shown,
            "husky   t 83.4 s   834 scans   412 MB\n"
            "mode degraded (lidar_late)   shed map_density   epoch 2\n"
            "faults: lidar_late, disk_failing\n"
            "\n"
            "task (ms)       p50    p99  p99.9    max deadline p99/deadline  over slips  miss  drop  queue\n"
            "safety         0.01   0.03   0.12   0.40     1.00 [=         ]     0     0     0     0    -   \n"
            "odometry      21.70  44.20  58.10  63.50    60.00 [========  ]     3     0     0     0   1/8  \n"
            "mapping       38.00    105    140    141    80.00 [!!!!!!!!!!]    61    12     2    44   8/8  \n"
            "\n"
            "events, newest first\n"
            "     83.1 s      1x  failsafe: lidar_late\n"
            "     12.3 s      7x  lidar: incomplete scan: packets were lost\n");
}

TEST(RenderTop, ShowsPeopleOfARobotThatFollowsThem) {
  app::LiveView view = support::sample_view();
  view.people = app::LiveView::People{.now = 0, .tracks = 4};
  EXPECT_THAT(text(view), HasSubstr("people: none   4 since the start\n"));
  view.people->now = 2;
  view.people->nearest_m = 1.26;
  EXPECT_THAT(text(view), HasSubstr("people: 2   nearest 1.3 m   4 since the start\n"));
}

TEST(RenderTop, ItsTextReachesTheTerminalAsTextAlone) {
  app::LiveView view = support::sample_view();
  view.robot = "\x1b[2Jevil\n\x07\xc3\xa9";
  view.events.push_back({1, "\x1b]0;title\x07", "\r\n", 1});
  view.stages[0].name = "\x9b\x1b[31m";
  for (const char c : text(view)) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << static_cast<int>(c);
}

TEST(RenderTop, NeverWiderNorLongerThanTheScreen) {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    app::LiveView view = support::sample_view();
    for (auto& stage : view.stages) {
      stage.max_ms = i % 3 == 0 ? std::numeric_limits<double>::quiet_NaN() : 1e300;
      stage.p99_ms = -1e300;
      stage.overruns = stage.slips = std::numeric_limits<std::uint64_t>::max();
      stage.queued = stage.capacity = random();
    }
    view.t_s = 1e300;
    const Screen screen{static_cast<int>(random() % 150), static_cast<int>(random() % 30), false};
    const auto lines = render(view, screen);
    EXPECT_LE(lines.size(), std::max<std::size_t>(1, static_cast<std::size_t>(screen.rows)));
    for (const auto& line : lines)
      EXPECT_LE(line.size(), std::max<std::size_t>(1, static_cast<std::size_t>(screen.columns)));
  }
}

TEST(RenderTop, LongEventsAreBrokenBetweenWords) {
  app::LiveView view = support::sample_view();
  view.events = {{12.3, "lidar", "incomplete scan: packets were lost or late, or the motor stood", 7}};
  EXPECT_THAT(text(view, {60, 40, false}), HasSubstr("     12.3 s      7x  lidar: incomplete scan: packets were\n"
                                                     "                     lost or late, or the motor stood\n"));
}

TEST(RenderTop, ColoursOnlyWhereAskedFor) {
  EXPECT_EQ(text(support::sample_view()).find('\x1b'), std::string::npos);
  EXPECT_THAT(text(support::sample_view(), {120, 40, true}), HasSubstr("\x1b[1;31mmapping"));
}

}  // namespace
}  // namespace cairn::cli
