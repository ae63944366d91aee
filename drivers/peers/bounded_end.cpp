// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/bounded_end.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

namespace cairn::peer_link {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a handler may use nothing else");

void request(int /*number*/) {
  if (!requested.exchange(true)) (void)::alarm(kEndPatience_s);
}

/// Makes nothing but system calls, as a handler must.
void leave(int /*number*/) {
  constexpr std::string_view kWhy = "cairn: the network's threads do not end in time; leaving without them\n";
  (void)!::write(STDERR_FILENO, kWhy.data(), kWhy.size());
  ::_exit(0);
}

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

}  // namespace

void catch_end_signals() {
  handle(SIGALRM, leave);
  handle(SIGINT, request);
  handle(SIGTERM, request);
}

bool end_requested() { return requested; }

}  // namespace cairn::peer_link
