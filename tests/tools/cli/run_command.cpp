// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/cli/run_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <sstream>

#include "onboard/app/cli/refusal.hpp"

namespace cairn::cli {

Outcome run(void (*add)(app::Commands&), std::vector<std::string> arguments) {
  CLI::App app;
  app::Commands commands{app, {}};
  add(commands);
  std::ostringstream out, err;
  std::streambuf* const old_out = std::cout.rdbuf(out.rdbuf());
  std::streambuf* const old_err = std::cerr.rdbuf(err.rdbuf());
  int code = app::kWrongArguments;
  try {
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
    app.parse(arguments);
    code = commands.job();
  } catch (const CLI::ParseError& e) {
    err << app::refusal_of(app, e);
  }
  std::cout.rdbuf(old_out);
  std::cerr.rdbuf(old_err);
  return {code, out.str(), err.str()};
}

}  // namespace cairn::cli
