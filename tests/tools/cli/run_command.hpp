// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "onboard/app/cli/command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::cli {

using support::TemporaryFolder;  // NOLINT(misc-unused-using-decls): those who include this use it

/// What a command said and how it ended.
struct Outcome {
  int exit_code;
  std::string out, err;
  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out, nullptr, false); }
};

/// Parses the arguments as main() does and runs the job, with stdout and stderr caught.
Outcome run(void (*add)(app::Commands&), std::vector<std::string> arguments);

}  // namespace cairn::cli
