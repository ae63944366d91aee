// SPDX-License-Identifier: Apache-2.0
// The program `cairn`: every command registers itself, the chosen one leaves its job, and the job's result is the exit
// code.
#include <CLI/CLI.hpp>

#include "onboard/app/run_command.hpp"
#include "tools/cli/commands.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Cairn: onboard software for teams of robots", "cairn"};
  app.set_version_flag("--version", CAIRN_VERSION);
  app.require_subcommand(1);

  cairn::cli::Commands commands{app, {}};
  cairn::cli::add_run_command(commands);
  cairn::cli::add_tool_commands(commands);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? cairn::cli::kDone : cairn::cli::kWrongArguments;
  }
  return commands.job();
}
