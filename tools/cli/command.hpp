// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

#include "hal/result.hpp"

namespace cairn::cli {

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

/// Says on stderr what failed and where. A faulty configuration counts as wrong arguments.
inline int fail(const Error& error) {
  std::cerr << "cairn: " << to_string(error) << '\n';
  return error.code == Errc::kInvalidConfig ? kWrongArguments : kFailed;
}

/// One JSON object on stdout and nothing else.
inline int print(const nlohmann::json& object) {
  std::cout << object.dump(2) << '\n';
  return kDone;
}

}  // namespace cairn::cli
