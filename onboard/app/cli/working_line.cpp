// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/cli/working_line.hpp"

#include <unistd.h>

namespace cairn::app {

std::FILE* terminal() { return ::isatty(STDERR_FILENO) != 0 ? stderr : nullptr; }

void WorkingLine::show() {
  std::unique_lock lock(mutex_);
  int seconds = 0;
  while (!ended_.wait_for(lock, period_, [&] { return over_; })) {
    std::fprintf(out_, "\r%s, %d s ", what_.c_str(), ++seconds);
    std::fflush(out_);
  }
  if (seconds > 0) std::fprintf(out_, "\r\x1b[K");
}

void WorkingLine::end() {
  const std::lock_guard lock(mutex_);
  over_ = true;
  ended_.notify_all();
}

}  // namespace cairn::app
