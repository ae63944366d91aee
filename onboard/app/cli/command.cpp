// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/cli/command.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <iostream>

#include "hal/files/standard_output.hpp"
#include "onboard/app/cli/refusal.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::app {
namespace {

int parse_and_run(Commands& commands, int argc, char** argv) {
  try {
    commands.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return commands.app.exit(error);  // --help and --version
    std::cerr << "cairn: " << refusal_of(commands.app, error) << '\n';
    return kWrongArguments;
  }
  return commands.job();
}

}  // namespace

int run_program(Commands& commands, int argc, char** argv) {
  return end_of_program("cairn", parse_and_run(commands, argc, argv));
}

std::string above_zero(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc{} && end == text.data() + text.size();
  return number && value > 0 && std::isfinite(value) ? "" : "must be a number above 0, and is \"" + text + "\"";
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
