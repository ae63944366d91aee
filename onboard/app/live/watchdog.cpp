// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/watchdog.hpp"

#include <algorithm>
#include <cstdio>

namespace cairn::app {
namespace {

/// One line, whatever the text holds.
std::string one_line(std::string_view text) {
  std::string line(text.substr(0, 400));
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return line;
}

}  // namespace

void Watchdog::ready(Time now) { tell(now, "READY=1"); }

bool Watchdog::step(Time now, std::string_view status) {
  const auto finding = supervisor_.step(now);
  if (finding) {
    accuse(now, *finding);
    return false;
  }
  hung_.clear();
  const Duration every = timeout_ ? *timeout_ / 4 : std::chrono::seconds(1);
  if (told_ && now - *told_ < every) return true;
  tell(now, (timeout_ ? "WATCHDOG=1\n" : "") + ("STATUS=" + one_line(status)));
  return true;
}

void Watchdog::accuse(Time now, const safety::Supervisor::Finding& finding) {
  const safety::Pulse& pulse = supervisor_.pulses()[finding.pulse];
  if (!hung_.empty() && accused_ == finding.pulse) return;
  accused_ = finding.pulse;
  hung_ = "task " + pulse.task + " hangs: no tick for " +
          std::to_string(finding.silent / std::chrono::milliseconds(1)) + " ms, its limit is " +
          std::to_string(pulse.limit / std::chrono::milliseconds(1)) + " ms";
  // At once, as event, on stderr and as status: the process may end before a client asks for the events.
  monitor_.event(now, "watchdog", "task " + pulse.task + " hangs");
  std::fprintf(stderr, "cairn: %s\n", hung_.c_str());
  tell(now, "STATUS=" + one_line(hung_));
}

void Watchdog::tell(Time now, const std::string& lines) {
  told_ = now;
  if (const auto told = notify_.notify(lines); !told) monitor_.event(now, "watchdog", to_string(told.error()));
}

}  // namespace cairn::app
