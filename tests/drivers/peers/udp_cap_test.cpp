// SPDX-License-Identifier: Apache-2.0
// The cap on what a peer process sends, measured at the network interface: a loopback of the test's own.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <deque>
#include <fstream>
#include <utility>

#include "hal/clock.hpp"
#include "tests/drivers/peers/peer.hpp"

namespace cairn::peer_link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A network of this process's own, with nothing but a loopback in it. False where the system does not allow that.
bool own_network() {
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWNET) != 0) return false;
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq request{};
  request.ifr_name[0] = 'l';
  request.ifr_name[1] = 'o';
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  const bool up = fd >= 0 && ::ioctl(fd, SIOCSIFFLAGS, &request) == 0;
  ::close(fd);
  return up;
}

/// Of this network's loopback, since it exists.
std::size_t bytes_on_the_wire() {
  std::ifstream devices("/proc/self/net/dev");
  for (std::string name; devices >> name;) {
    if (name != "lo:") continue;
    std::size_t bytes = 0;
    devices >> bytes;
    return bytes;
  }
  return 0;
}

/// What had been sent at some moment between two readings of the clock.
struct Sample {
  Time before, after;
  std::size_t bytes = 0;
};

/// The most bytes between two samples that surely lie within one second.
class BusiestSecond {
 public:
  void add(const Sample& sample) {
    samples_.push_back(sample);
    while (!samples_.empty() && samples_.front().before + seconds(1) < sample.after) samples_.pop_front();
    if (!samples_.empty()) most = std::max(most, sample.bytes - samples_.front().bytes);
  }
  std::size_t most = 0;

 private:
  std::deque<Sample> samples_;
};

/// The most bytes in any second of the time over which one process is asked to send all it can, and the mean.
std::pair<std::size_t, double> flood(const std::string& cap) {
  const support::TemporaryFolder folder;
  Peer loud(1, folder.path(), "50", cap), quiet(2, folder.path(), "50");
  EXPECT_TRUE(arrives(quiet, loud, 0, datagram(1, 40)));
  EXPECT_TRUE(arrives(loud, quiet, 2, datagram(3, 40)));
  quiet.signal(SIGSTOP);  // it sends nothing now; until its lease is over, everything goes on being sent to it
  const LiveClock clock;
  const Time begin = clock.now();
  BusiestSecond busiest;
  const std::size_t before = bytes_on_the_wire();
  while (clock.now() < begin + milliseconds(2500)) {
    for (int i = 0; i < 5; ++i) loud.link.send({LinkFrame::Kind::kSend, 2, datagram(3, 900)});
    (void)loud.received();  // waits a little
    Sample sample{clock.now(), {}, bytes_on_the_wire()};
    sample.after = clock.now();
    busiest.add(sample);
  }
  quiet.signal(SIGCONT);
  return {busiest.most, static_cast<double>(bytes_on_the_wire() - before) / to_seconds(clock.now() - begin)};
}

TEST(UdpCap, NoSecondIsAboveTheCapAtTheInterface) {
  constexpr std::size_t kHeldUp = 900 + 160;  // a process that is stopped between counting a datagram and sending it
  if (!own_network()) GTEST_SKIP() << "needs a network namespace";
  for (const std::size_t kbit : {64U, 256U}) {
    const std::size_t cap = kbit * 1000 / 8;
    const auto [most, mean] = flood(std::to_string(cap));  // how much of the cap is used is a matter of TokenBucket
    EXPECT_LE(most, cap + kHeldUp) << kbit << " kbit/s";
    EXPECT_GT(mean, 0) << "something goes out";
    RecordProperty(std::to_string(kbit) + "kbit_most_bytes", static_cast<int>(most));
    std::printf("%zu kbit/s: at most %zu bytes in a second of %zu, mean %.0f\n", kbit, most, cap, mean);
  }
}

}  // namespace
}  // namespace cairn::peer_link
