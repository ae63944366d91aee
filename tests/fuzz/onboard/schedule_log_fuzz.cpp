// SPDX-License-Identifier: Apache-2.0
// Any text in place of a schedule log: an error, or ticks in rising order whose releases a Time can hold.
#include <string_view>

#include "onboard/scheduler/schedule_log.hpp"
#include "tests/fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace cairn;
  const auto log = scheduler::parse_schedule_log({reinterpret_cast<const char*>(data), size});
  if (!log) return 0;
  for (const scheduler::TaskLog& task : log->tasks) {
    std::uint64_t next = 0;
    for (const scheduler::TickRecord& tick : task.ticks) {
      require(tick.index >= next + tick.skipped && tick.index < task.end);
      next = tick.index + 1;
    }
    require(task.releases.period > Duration{} && task.releases.at(task.end) >= task.releases.first);
  }
  return 0;
}
