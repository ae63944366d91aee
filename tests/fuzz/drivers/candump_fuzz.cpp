// SPDX-License-Identifier: Apache-2.0
// Any text: every line is a frame, no frame, or an error with a column inside the line. What was read, written and read
// again is the same.
#include <cstdlib>
#include <string>
#include <string_view>

#include "drivers/drive/can/candump.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn::drive;
  std::string_view text(reinterpret_cast<const char*>(data), size);
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const auto parsed = parse_candump(line);
    if (!parsed) {
      if (!parsed.error().offset || *parsed.error().offset > line.size()) std::abort();
      continue;
    }
    if (!*parsed) continue;
    const CandumpLine& first = **parsed;
    cairn::Packet packet;
    encode_frame(first.frame, packet);
    const auto decoded = decode_frame(packet.payload());
    if (!decoded || !(*decoded == first.frame)) std::abort();
    const cairn::Time stamp{
        std::chrono::duration_cast<std::chrono::microseconds>(first.stamp.value_or(cairn::Time{}).time_since_epoch())};
    std::string written;
    append_candump(written, stamp, first.interface, first.frame, first.direction);
    const auto again = parse_candump(written);
    if (!again || !*again) std::abort();
    if (!((*again)->frame == first.frame) || (*again)->stamp != stamp || (*again)->interface != first.interface ||
        (*again)->direction != first.direction)
      std::abort();
  }
  return 0;
}
