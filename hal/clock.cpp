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
  // Bracketed, so that a preemption between the two reads costs half its length at most.
  const Duration before = read(CLOCK_MONOTONIC);
  const Duration realtime = read(CLOCK_REALTIME);
  const Duration after = read(CLOCK_MONOTONIC);
  return realtime - (before + (after - before) / 2);
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
