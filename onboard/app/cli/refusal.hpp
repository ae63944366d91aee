// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace cairn::app {

/// Why a command line was refused, as one or two sentences: which command or option does not exist and which was
/// probably meant, or what else is wrong; and the help that says more. `app` is the one that threw `error`.
[[nodiscard]] std::string refusal_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace cairn::app
