// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/result.hpp"

namespace cairn::app {

/// From now on SIGINT and SIGTERM ask for an orderly end. Further ones do nothing: they must not cost what the program
/// is about to write. One that comes a second after the first says so on stderr, and that SIGQUIT (Ctrl-\) kills.
void catch_stop_signals();
/// Any thread: such a signal has come.
[[nodiscard]] bool stop_requested();

/// What a command says that ended early because of such a signal. `what`: what it worked on.
[[nodiscard]] Error interrupted(std::string what, std::string remedy);

}  // namespace cairn::app
