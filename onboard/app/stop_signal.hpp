// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cairn {

/// From now on SIGINT and SIGTERM ask for an orderly end instead of killing the program; a second one kills it.
void catch_stop_signals();
[[nodiscard]] bool stop_requested();

}  // namespace cairn
