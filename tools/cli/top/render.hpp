// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "onboard/app/live/live_view.hpp"

namespace cairn::cli {

struct Screen {
  int columns = 80, rows = 24;
  bool colour = false;  ///< ANSI colours for what is wrong
};

/// A live view as lines of a terminal, none wider than the screen and not more than it has rows: stages first, then as
/// many events as fit, newest first. Pure. Characters that a terminal would obey are replaced.
[[nodiscard]] std::vector<std::string> render(const app::LiveView& view, const Screen& screen);

}  // namespace cairn::cli
