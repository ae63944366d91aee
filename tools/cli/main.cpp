// SPDX-License-Identifier: Apache-2.0
// The program `cairn`, the toolbox: every command registers itself, and the chosen one leaves its job.
#include <CLI/CLI.hpp>

#include "onboard/app/run_command.hpp"
#include "tools/cli/commands.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Cairn: onboard software for teams of robots", "cairn"};
  app.set_version_flag("--version", CAIRN_VERSION);
  app.require_subcommand(1);

  cairn::app::Commands commands{app, {}};
  cairn::app::add_run_command(commands);
  cairn::cli::add_tool_commands(commands);
  return cairn::app::run_program(commands, argc, argv);
}
