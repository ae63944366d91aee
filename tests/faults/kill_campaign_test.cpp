// SPDX-License-Identifier: Apache-2.0
// Kills a core that saves its map, at random instants, again and again. CAIRN_KILLS: how often (10 without);
// CAIRN_RESTART_LIMIT_S: how long a restart may take (without: it is only said).
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "hal/clock.hpp"
#include "onboard/app/generations.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::faults {
namespace {

/// The map saver as a child, and what it says.
class Saver {
 public:
  explicit Saver(const std::string& folder) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(ends[1], STDOUT_FILENO);
      ::close(ends[0]);
      ::execl(CAIRN_MAP_SAVER, "map_saver", folder.c_str(), nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    out_ = ends[0];
  }
  Saver(const Saver&) = delete;
  Saver& operator=(const Saver&) = delete;
  ~Saver() {
    if (pid_ > 0) (void)kill();
    ::close(out_);
  }

  /// The next line that comes within the time; empty: none did, or the child has ended.
  std::string line(int timeout_ms) {
    for (;;) {
      if (const std::size_t end = text_.find('\n'); end != std::string::npos) {
        const std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        return line;
      }
      pollfd waiting{out_, POLLIN, 0};
      std::array<char, 512> bytes{};
      if (::poll(&waiting, 1, timeout_ms) <= 0) return {};
      const ssize_t n = ::read(out_, bytes.data(), bytes.size());
      if (n <= 0) return {};
      text_.append(bytes.data(), static_cast<std::size_t>(n));
    }
  }
  /// Whether it was still running until then.
  bool kill() {
    int status = 0;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFSIGNALED(status);
  }

 private:
  pid_t pid_ = -1;
  int out_ = -1;
  std::string text_;
};

long from_environment(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtol(text, nullptr, 10) : otherwise;
}

/// The number behind a word; −1: another line.
long number(const std::string& line, const std::string& word) {
  return line.starts_with(word + " ") ? std::strtol(line.c_str() + word.size(), nullptr, 10) : -1;
}

TEST(KillCampaign, AWholeMapIsThereAfterEveryKill) {
  const support::TemporaryFolder folder;
  const LiveClock clock;
  std::mt19937_64 random(1);
  const long kills = from_environment("CAIRN_KILLS", 10), limit_s = from_environment("CAIRN_RESTART_LIMIT_S", 0);
  long confirmed = 0;
  std::vector<Duration> restarts;
  for (long i = 0; i < kills; ++i) {
    const Time begin = clock.now();
    Saver saver(folder.path());
    const std::string first = saver.line(20'000);
    ASSERT_GE(number(first, "ready"), confirmed)
        << "kill " << i << ": " << first << ": an older map than was confirmed";
    restarts.push_back(clock.now() - begin);
    const auto more = static_cast<long>(random() % 6);
    for (long k = 0; k < more; ++k) confirmed = std::max(confirmed, number(saver.line(20'000), "saved"));
    // And somewhere in what follows: within a save, as a rule.
    const std::string last = saver.line(static_cast<int>(random() % 12));
    confirmed = std::max(confirmed, number(last, "saved"));
    ASSERT_TRUE(saver.kill()) << "it ended by itself after " << last;
  }
  Monitor monitor;
  const auto newest = Generations(folder.path(), monitor).load(Time{});
  EXPECT_TRUE(monitor.events().empty());
  EXPECT_TRUE(newest || confirmed == 0);
  std::sort(restarts.begin(), restarts.end());
  std::cout << kills << " kills, " << confirmed << " generations confirmed; restart until ready: median "
            << to_milliseconds(restarts[restarts.size() / 2]) << " ms, worst " << to_milliseconds(restarts.back())
            << " ms\n";
  EXPECT_TRUE(limit_s == 0 || restarts.back() <= std::chrono::seconds(limit_s));
}

}  // namespace
}  // namespace cairn::faults
