// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/stop_signal.hpp"

#include <csignal>
#include <cstdint>
#include <ctime>

namespace cairn {
namespace {

volatile std::sig_atomic_t requested = 0;
std::int64_t requested_ns = 0, patience_ns = 0;  // of the monotonic clock; only the handler uses them afterwards

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

void request(int number) {
  const std::int64_t now = now_ns();
  if (requested == 0) {
    requested_ns = now;
    requested = 1;
  } else if (now - requested_ns >= patience_ns) {
    (void)std::signal(number, SIG_DFL);
    (void)std::raise(number);
  }
}

}  // namespace

void catch_stop_signals(Duration patience) {
  patience_ns = patience.count();
  struct sigaction action {};
  action.sa_handler = request;
  sigemptyset(&action.sa_mask);
  // Neither interrupts the other: the handler's state is its own.
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() { return requested != 0; }

}  // namespace cairn
