// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/top/top_command.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <fstream>

#include "hal/workers.hpp"
#include "onboard/app/live/live_server.hpp"
#include "tests/support/sample_view.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

/// The command against a core that says `line` again and again.
Outcome top(const std::string& line, std::vector<std::string> arguments) {
  const TemporaryFolder folder;
  auto server = app::LiveServer::open(folder / "s").value();
  arguments.insert(arguments.begin(), {"top", "--socket", (folder / "s").string()});
  Outcome outcome{};
  std::atomic<bool> done{false};
  Workers two(2);
  std::atomic<int> chunk{0};
  two.for_each(2, [&](std::size_t) {
    if (chunk.fetch_add(1) == 0) {
      outcome = run(add_top_command, arguments);
      done = true;
    } else {
      while (!done) server.publish(line);
    }
  });
  return outcome;
}

TEST(TopCommand, OnceShowsOneView) {
  const Outcome o = top(app::to_line(support::sample_view()), {"--once"});
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_THAT(o.out, HasSubstr("mode degraded (lidar_late)"));
  EXPECT_THAT(o.out, HasSubstr("odometry"));
}

TEST(TopCommand, JsonIsTheLine) {
  const Outcome o = top(app::to_line(support::sample_view()), {"--once", "--json"});
  EXPECT_EQ(o.out, app::to_line(support::sample_view()));
}

TEST(TopCommand, BytesThatAreNoViewAreAnError) {
  EXPECT_EQ(top("no json\n", {}).exit_code, app::kFailed);
  const Outcome endless = top(std::string(50'000, 'x'), {});
  EXPECT_EQ(endless.exit_code, app::kFailed);
  EXPECT_THAT(endless.err, HasSubstr("without an end"));
}

TEST(TopCommand, WithoutACoreItSaysSo) {
  const TemporaryFolder folder;
  const Outcome o = run(add_top_command, {"top", "--socket", folder / "none"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("no core serves this socket"));
}

}  // namespace
}  // namespace cairn::cli
