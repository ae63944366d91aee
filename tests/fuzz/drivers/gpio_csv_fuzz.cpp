// SPDX-License-Identifier: Apache-2.0
// Any text: every line is a row, none, or an error with a column inside the line; rows survive being written. The rows
// go to an e-stop, which must never be released while the contact is open.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include "drivers/gpio/estop.hpp"
#include "drivers/gpio/line_event.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  using namespace cairn::gpio;
  std::string_view text(reinterpret_cast<const char*>(data), size);
  EStop stop{Config{}};
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const auto row = parse_csv(line);
    if (!row) {
      if (!row.error().offset || *row.error().offset > line.size()) std::abort();
      continue;
    }
    if (!*row) continue;
    std::string written;
    append_csv(written, (*row)->stamp_ns, (*row)->line, (*row)->level);
    const auto again = parse_csv(written);
    if (!again || !*again || (*again)->stamp_ns != (*row)->stamp_ns || (*again)->line != (*row)->line ||
        (*again)->level != (*row)->level)
      std::abort();
    const Time stamp{Duration{(*row)->stamp_ns}};
    if ((*row)->line == "estop") stop.edge(stamp, (*row)->level, 0);
    if ((*row)->line == "level") stop.level(stamp, (*row)->level);
    const bool armed = stop.rearm(stamp).has_value();
    if (armed && !(*row)->level && ((*row)->line == "estop" || (*row)->line == "level")) std::abort();
  }
  return 0;
}
