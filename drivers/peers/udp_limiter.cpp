// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/udp_limiter.hpp"

#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <mutex>

#include "drivers/peers/token_bucket.hpp"
#include "hal/clock.hpp"

namespace cairn::peer_link {
namespace {

constexpr std::size_t kHeaders = 14 + 20 + 8;  // Ethernet, IPv4, UDP

class Limiter {
 public:
  void limit(const UdpLimits& limits) {
    const std::scoped_lock lock(mutex_);
    limited_ = limits.bytes_per_second > 0;
    bucket_ = TokenBucket(static_cast<double>(limits.bytes_per_second));
  }
  bool pass(std::size_t bytes, bool urgent) {
    const std::scoped_lock lock(mutex_);
    const bool passes = !limited_ || bucket_.take(bytes, clock_.now(), urgent);
    counters_.sent += passes ? 1 : 0;
    counters_.sent_bytes += passes ? bytes : 0;
    counters_.dropped += passes ? 0 : 1;
    return passes;
  }
  bool room(std::size_t bytes) {
    const std::scoped_lock lock(mutex_);
    return !limited_ || bucket_.has(bytes, clock_.now());
  }
  UdpCounters counters() {
    const std::scoped_lock lock(mutex_);
    return counters_;
  }

 private:
  std::mutex mutex_;
  LiveClock clock_;
  bool limited_ = false;
  TokenBucket bucket_{0};
  UdpCounters counters_;
};

Limiter& limiter() {
  static Limiter limiter;
  return limiter;
}

/// Discovery goes to even ports, data to odd ones (RTPS 2.5, 9.6.1). Without discovery nobody finds anybody.
bool is_discovery(const sockaddr& to) {
  return to.sa_family == AF_INET && ntohs(reinterpret_cast<const sockaddr_in&>(to).sin_port) % 2 == 0;
}

std::size_t length_of(const msghdr& message) {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < message.msg_iovlen; ++i) bytes += message.msg_iov[i].iov_len;
  return bytes;
}

}  // namespace

void limit_udp(const UdpLimits& limits) { limiter().limit(limits); }
bool udp_room(std::size_t bytes) { return limiter().room(bytes); }
UdpCounters udp_counters() { return limiter().counters(); }

}  // namespace cairn::peer_link

/// Stands before the C library's.
extern "C" ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  using Function = ssize_t (*)(int, const msghdr*, int);
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "sendmsg"));
  const auto* to = static_cast<const sockaddr*>(message->msg_name);
  const bool internet = to != nullptr && (to->sa_family == AF_INET || to->sa_family == AF_INET6);
  const std::size_t bytes = cairn::peer_link::length_of(*message);
  if (internet &&
      !cairn::peer_link::limiter().pass(bytes + cairn::peer_link::kHeaders, cairn::peer_link::is_discovery(*to)))
    return static_cast<ssize_t>(bytes);
  return real(socket, message, flags);
}
