// SPDX-License-Identifier: Apache-2.0
// A core's end of robot.sock for the commands that read it, without a robot.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "hal/workers.hpp"
#include "onboard/app/streams/streams_task.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli::test {

/// Runs a command while the streams of a core are served. `each_tick` may fill the outlets. `prepare` is called before.
inline Outcome run_beside_core(
    void (*add)(app::Commands&), std::vector<std::string> arguments,
    const std::function<void(app::StreamOutlets&, int tick)>& each_tick,
    const std::function<void(app::StreamsTask&)>& prepare = [](app::StreamsTask&) {}) {
  const TemporaryFolder folder;
  Monitor monitor;
  app::StreamOutlets outlets;
  auto hub = app::ClientHub::open(folder / "", {.robot = "husky", .session = 9, .resolution_m = 0.2}, monitor).value();
  app::StreamsTask task(std::move(hub), 9, 0, outlets, monitor);
  prepare(task);
  arguments.insert(arguments.end(), {"--socket", (folder / "robot.sock").string()});
  int ticks = 0;
  const LiveClock clock;
  const auto serve = [&] {
    each_tick(outlets, ticks++);
    scheduler::TickRecord record;
    scheduler::Tick tick(scheduler::Regime::kLive, clock.now(), record);
    task.tick(tick);
  };
  for (int i = 0; i < 10; ++i) serve();
  Outcome outcome{};
  std::atomic<bool> done{false};
  Workers two(2);
  two.for_each(2, [&](std::size_t side) {
    if (side == 0) {
      outcome = run(add, arguments);
      done = true;
      return;
    }
    while (!done) {
      serve();
      LiveClock::wait_until(clock.now() + std::chrono::milliseconds(1));
    }
  });
  return outcome;
}

}  // namespace cairn::cli::test
