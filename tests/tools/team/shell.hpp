// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "hal/clock.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/team/process.hpp"

namespace cairn::team_run {

/// A shell that stands in for a robot's process; it works in `folder`.
inline Command shell(const std::string& script, const std::filesystem::path& folder) {
  return {{"/bin/sh", "-c", script}, folder, folder / "log"};
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Waits until it is so; gives up after ten minutes, as only a fault makes it.
inline bool becomes_true(const std::function<bool()>& is_so) {
  const LiveClock clock;
  for (const Time last = clock.now() + std::chrono::minutes(10); clock.now() < last;) {
    if (is_so()) return true;
    (void)::poll(nullptr, 0, 5);
  }
  return false;
}

}  // namespace cairn::team_run
