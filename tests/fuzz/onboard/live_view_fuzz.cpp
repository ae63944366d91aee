// SPDX-License-Identifier: Apache-2.0
// Any bytes from the live socket: an error, or a view that is bounded, survives being written, and fits a terminal.
#include <cmath>
#include <string_view>

#include "onboard/app/live/live_view.hpp"
#include "tests/fuzz/require.hpp"
#include "tools/cli/top/render.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  const auto view = app::parse_line({reinterpret_cast<const char*>(data), size});
  if (!view) return 0;
  require(view->stages.size() <= app::LiveView::kMaxItems && view->events.size() <= app::LiveView::kMaxItems);
  require(view->faults.size() <= app::LiveView::kMaxItems && std::isfinite(view->t_s));
  const std::string line = app::to_line(*view);
  require(line.find('\n') == line.size() - 1);
  const auto again = app::parse_line(line);
  require(line.size() > app::LiveView::kMaxLine || (again && app::to_line(*again) == line));
  const cli::Screen screen{static_cast<int>(size % 200), static_cast<int>(size % 50), false};
  for (const std::string& row : cli::render(*view, screen))
    for (const char c : row) require(c >= ' ' && c <= '~');
  return 0;
}
