// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hal/result.hpp"

namespace CLI {
class App;
}

namespace cairn::app {

/// Exit codes that scripts rely on.
inline constexpr int kDone = 0, kFailed = 1, kWrongArguments = 2;

/// What the command line asked for. A subcommand registers itself with `app` and, when it is the chosen one, leaves its
/// work in `job`; main() runs it.
///
///     auto* sub = commands.app.add_subcommand("import", "foreign data → recording");
///     auto options = std::make_shared<Options>();
///     sub->add_option("kind", options->kind, "…")->required();
///     sub->callback([&commands, options] { commands.job = [options] { return import(*options); }; });
struct Commands {
  CLI::App& app;
  std::function<int()> job;
};

/// Parses the command line and runs the job that it asks for. Returns the program's exit code, which is not 0 where
/// stdout did not take what was printed.
int run_program(Commands& commands, int argc, char** argv);

/// For CLI11's check(): what is wrong with a number that has to be above 0; empty: nothing.
[[nodiscard]] std::string above_zero(const std::string& text);

/// Says on stderr what failed and where. A faulty configuration counts as wrong arguments.
int fail(const Error& error);

/// One JSON object on stdout and nothing else. Bytes that are not UTF-8 are replaced: a file's name may hold any.
int print(const nlohmann::ordered_json& object);

}  // namespace cairn::app
