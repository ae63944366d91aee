// SPDX-License-Identifier: Apache-2.0
// The program `cairn-core`: one robot, and nothing of the toolbox. Its options are those of `cairn run`.
#include <CLI/CLI.hpp>

#include "onboard/app/run_command.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Cairn's core: one robot, live or from a recording; the same code as `cairn run`", "cairn-core"};
  app.set_version_flag("--version", CAIRN_VERSION);

  cairn::app::Commands commands{app, {}};
  cairn::app::add_run_options(app, commands);
  return cairn::app::run_program(commands, argc, argv);
}
