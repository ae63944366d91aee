// SPDX-License-Identifier: Apache-2.0
#include "hal/clock.hpp"

#include <cerrno>
#include <ctime>

namespace cairn {
namespace {

Duration read(clockid_t id) {
  timespec t{};
  clock_gettime(id, &t);
  return std::chrono::seconds{t.tv_sec} + std::chrono::nanoseconds{t.tv_nsec};
}

}  // namespace

Time LiveClock::now() const { return Time{read(CLOCK_MONOTONIC)}; }

Duration LiveClock::realtime_offset() {
  // Bracketed, and again after a preemption between the reads, which would cost half its length.
  constexpr Duration kTight = std::chrono::microseconds(20);
  constexpr int kTries = 5;
  Duration offset{}, width = Duration::max();
  for (int tries = 0; tries < kTries && width > kTight; ++tries) {
    const Duration before = read(CLOCK_MONOTONIC);
    const Duration realtime = read(CLOCK_REALTIME);
    const Duration after = read(CLOCK_MONOTONIC);
    if (after - before >= width) continue;
    width = after - before;
    offset = realtime - (before + width / 2);
  }
  return offset;
}

void LiveClock::wait_until(Time t) {
  const Duration d = t.time_since_epoch();
  const timespec until{static_cast<std::time_t>(d.count() / 1'000'000'000),
                       static_cast<long>(d.count() % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

Duration thread_cpu_time() { return read(CLOCK_THREAD_CPUTIME_ID); }

}  // namespace cairn
