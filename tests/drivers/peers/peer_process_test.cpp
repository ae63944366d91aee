// SPDX-License-Identifier: Apache-2.0
// Two peer processes over Cyclone DDS on loopback; the test is the core of both.
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include "drivers/peers/local_link.hpp"
#include "hal/clock.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::peers {
namespace {

using std::chrono::seconds;

/// A peer process and the core's end of its socket.
class Peer {
 public:
  Peer(std::uint64_t robot, const std::filesystem::path& folder, std::string domain)
      : robot_(std::to_string(robot)),
        socket_(folder / ("peers" + robot_ + ".sock")),
        domain_(std::move(domain)),
        link(LocalLink::listen(socket_).value()) {
    start();
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() { stop(SIGTERM); }

  void start() {
    std::vector<std::string> words{CAIRN_PEERS, "--robot",     robot_, "--socket", socket_, "--peer",
                                   "127.0.0.1", "--interface", "lo",   "--domain", domain_, "--quiet"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ASSERT_EQ(::posix_spawn(&process_, CAIRN_PEERS, nullptr, nullptr, arguments.data(), environ), 0);
  }
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
  std::vector<std::vector<std::byte>> received() {
    link.join();
    pollfd waited{link.readable_fd(), POLLIN, 0};
    (void)::poll(&waited, 1, 20);
    std::vector<std::vector<std::byte>> all;
    std::vector<std::byte> memory;
    for (LinkFrame frame; link.receive(memory, frame);) all.emplace_back(frame.bytes.begin(), frame.bytes.end());
    return all;
  }

 private:
  std::string robot_;
  std::filesystem::path socket_;
  std::string domain_;
  ::pid_t process_ = 0;

 public:
  LocalLink link;
};

std::vector<std::byte> datagram(unsigned kind, std::size_t size) {
  std::vector<std::byte> bytes(size, std::byte{7});
  bytes[0] = std::byte{1};
  bytes[1] = static_cast<std::byte>(kind);
  return bytes;
}

/// Sends until the other side has it: discovery takes a moment, and nothing is kept for who is not there.
bool arrives(Peer& from, Peer& to, std::uint64_t robot, const std::vector<std::byte>& bytes) {
  const LiveClock clock;
  for (const Time end = clock.now() + seconds(30); clock.now() < end;) {
    from.link.join();
    from.link.send({LinkFrame::Kind::kSend, robot, bytes});
    for (const auto& got : to.received())
      if (got == bytes) return true;
  }
  return false;
}

std::string own_domain() { return std::to_string(10 + ::getpid() % 200); }

TEST(PeerProcess, CarriesDatagramsAndComesBackAfterBeingKilled) {
  const support::TemporaryFolder folder;
  Peer one(1, folder.path(), own_domain()), two(2, folder.path(), own_domain());
  EXPECT_TRUE(arrives(one, two, 0, datagram(1, 40)));
  EXPECT_TRUE(arrives(two, one, 0, datagram(2, 1200)));
  EXPECT_TRUE(arrives(one, two, 2, datagram(3, 1100)));
  two.stop(SIGKILL);
  two.start();
  EXPECT_TRUE(arrives(one, two, 2, datagram(3, 900)));
  EXPECT_TRUE(arrives(two, one, 1, datagram(3, 901)));
  EXPECT_EQ(one.stop(SIGTERM), 0);
}

}  // namespace
}  // namespace cairn::peers
