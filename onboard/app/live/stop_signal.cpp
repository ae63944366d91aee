// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/stop_signal.hpp"

#include <csignal>

#include "hal/clock.hpp"

namespace cairn::app {
namespace {

volatile std::sig_atomic_t requested = 0;
Time requested_at;  // this and the next: only the handler uses them once signals are caught
Duration least_pause{};

void request(int number) {
  const Time now = LiveClock().now();  // one system call, as a handler may make it
  if (requested == 0) {
    requested_at = now;
    requested = 1;
  } else if (now - requested_at >= least_pause) {
    (void)std::signal(number, SIG_DFL);
    (void)std::raise(number);
  }
}

}  // namespace

void catch_stop_signals(Duration patience) {
  least_pause = patience;
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

}  // namespace cairn::app
