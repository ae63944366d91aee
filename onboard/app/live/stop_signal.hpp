// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/time.hpp"

namespace cairn::app {

/// From now on SIGINT and SIGTERM ask for an orderly end instead of killing the program. One that comes `patience`
/// after the first kills it. Sooner ones do nothing: timeout(1) and supervisors signal a program and then its whole
/// group.
void catch_stop_signals(Duration patience = std::chrono::seconds(1));
[[nodiscard]] bool stop_requested();

}  // namespace cairn::app
