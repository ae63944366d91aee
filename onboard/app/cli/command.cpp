// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/cli/command.hpp"

#include <CLI/CLI.hpp>
#include <iostream>

#include "onboard/report/json/report_json.hpp"

namespace cairn::app {

int run_program(Commands& commands, int argc, char** argv) {
  try {
    commands.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return commands.app.exit(error) == 0 ? kDone : kWrongArguments;
  }
  return commands.job();
}

int fail(const Error& error) {
  std::cerr << "cairn: " << to_string(error) << '\n';
  return error.code == Errc::kInvalidConfig ? kWrongArguments : kFailed;
}

int print(const report::Json& object) {
  std::cout << report::to_text(object);
  return kDone;
}

}  // namespace cairn::app
