// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "hal/result.hpp"
#include "tools/simulator/live/live_simulation.hpp"

namespace CLI {
class App;
}

namespace cairn::cli {

/// What `cairn simulate --live` was asked for, beside what it shares with recordings.
struct LiveArguments {
  bool live = false;
  std::string to = "127.0.0.1:2368";
  std::vector<double> start;  ///< x, y [m], yaw [rad]
  simulator::LiveConfig config;
};

/// The options of their own, in a group of the help.
void add_live_options(CLI::App& sub, LiveArguments& arguments);
/// Options that were given and have no meaning with, or without, --live. Error kInvalidConfig names one and the remedy.
[[nodiscard]] Result<void> check_live_options(const CLI::App& sub, bool live);
/// Plays the world. The result is the program's exit code.
int run_live(const LiveArguments& arguments, bool json);

}  // namespace cairn::cli
