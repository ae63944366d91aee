// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/live/stop_signal.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <utility>

#include "hal/clock.hpp"

namespace cairn::app {
namespace {

// timeout(1) and supervisors signal a program and then its whole group: that is one wish, not two.
constexpr Duration kOneWish = std::chrono::seconds(1);

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a handler may use nothing else");
std::atomic<Time::rep> requested_at{0};  // only the handler uses it, on any thread
static_assert(std::atomic<Time::rep>::is_always_lock_free, "a handler may use nothing else");

/// Makes nothing but system calls, as a handler must.
void request(int /*number*/) {
  const int error = errno;
  const Time::rep now = LiveClock().now().time_since_epoch().count();
  if (!requested.exchange(true)) {
    requested_at = now;
  } else if (now - requested_at >= kOneWish.count()) {
    constexpr std::string_view kHint =
        "\ncairn: is coming to its end; Ctrl-\\ kills it at once, and its results are lost\n";
    (void)!::write(STDERR_FILENO, kHint.data(), kHint.size());
  }
  errno = error;
}

}  // namespace

void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = request;
  sigemptyset(&action.sa_mask);
  // Neither interrupts the other: the handler's state is its own.
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() { return requested; }

Error interrupted(std::string what, std::string remedy) {
  return {Errc::kTruncated, "interrupted before the end", std::move(what), {}, std::move(remedy)};
}

}  // namespace cairn::app
