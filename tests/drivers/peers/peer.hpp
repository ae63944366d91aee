// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "drivers/peers/local_link.hpp"
#include "hal/clock.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::peer_link {

/// A peer process and the core's end of its socket.
class Peer {
 public:
  /// `log`: takes what the process writes to stderr; empty: the test's own.
  Peer(std::uint64_t robot, const std::filesystem::path& folder, std::string domain, std::string cap = "1000000",
       std::filesystem::path log = {})
      : robot_(std::to_string(robot)),
        socket_(folder / ("peers" + robot_ + ".sock")),
        domain_(std::move(domain)),
        cap_(std::move(cap)),
        log_(std::move(log)),
        link(LocalLink::listen(socket_).value()) {
    start();
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() { stop(SIGTERM); }

  void start() {
    std::vector<std::string> words{places::program("cairn-peers"),
                                   "--robot",
                                   robot_,
                                   "--socket",
                                   socket_,
                                   "--peer",
                                   "127.0.0.1",
                                   "--interface",
                                   "lo",
                                   "--robots-per-address",
                                   "4",
                                   "--domain",
                                   domain_,
                                   "--quiet",
                                   "--bytes-per-second",
                                   cap_};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    ::posix_spawn_file_actions_init(&files);
    if (!log_.empty())
      ::posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    ASSERT_EQ(
        ::posix_spawn(&process_, places::program("cairn-peers").c_str(), &files, nullptr, arguments.data(), environ),
        0);
    ::posix_spawn_file_actions_destroy(&files);
  }
  void signal(int number) const { ::kill(process_, number); }
  int stop(int signal) {
    int status = 0;
    if (process_ > 0) {
      ::kill(process_, signal);
      ::waitpid(process_, &status, 0);
    }
    process_ = 0;
    return status;
  }
  /// Bytes that came within a moment.
  std::vector<std::vector<std::byte>> received(int wait_ms = 20) {
    link.join();
    pollfd waited{link.readable_fd(), POLLIN, 0};
    (void)::poll(&waited, 1, wait_ms);
    std::vector<std::vector<std::byte>> all;
    std::vector<std::byte> memory;
    for (LinkFrame frame; link.receive(memory, frame);) all.emplace_back(frame.bytes.begin(), frame.bytes.end());
    return all;
  }

 private:
  std::string robot_;
  std::filesystem::path socket_;
  std::string domain_, cap_;
  std::filesystem::path log_;
  ::pid_t process_ = 0;

 public:
  LocalLink link;
};

inline std::vector<std::byte> datagram(unsigned kind, std::size_t size) {
  std::vector<std::byte> bytes(size, std::byte{7});
  bytes[0] = std::byte{1};
  bytes[1] = static_cast<std::byte>(kind);
  return bytes;
}

/// Sends until the other side has it: discovery takes a moment, and nothing is kept for who is not there. Adds to
/// `before` what else came until then. Gives up after five minutes, as only a fault makes it.
inline bool arrives(Peer& from, Peer& to, std::uint64_t robot, const std::vector<std::byte>& bytes,
                    std::vector<std::vector<std::byte>>* before = nullptr) {
  const LiveClock clock;
  for (const Time end = clock.now() + std::chrono::minutes(5); clock.now() < end;) {
    from.link.join();
    from.link.send({LinkFrame::Kind::kSend, robot, bytes});
    for (const auto& got : to.received(100)) {
      if (got == bytes) return true;
      if (before != nullptr) before->push_back(got);
    }
  }
  return false;
}

}  // namespace cairn::peer_link
