// SPDX-License-Identifier: Apache-2.0
// Robots with real peer processes over the emulated radio, with stand-ins for their cores.
#include "tools/team/network/network.hpp"
#include "tests/support/places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <set>

#include "tests/tools/team/shell.hpp"
#include "tools/team/supervisor.hpp"

namespace cairn::team_run {
namespace {

namespace fs = std::filesystem;
constexpr Index kRobots = 3;
constexpr std::size_t kItems = 30;

std::vector<fs::path> robot_folders(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (Index i = 1; i <= kRobots; ++i) {
    folders.push_back(folder / ("robot_" + std::to_string(i)));
    fs::create_directory(folders.back());
  }
  return folders;
}

Supervision stand_ins(const Network& network, const std::vector<fs::path>& folders) {
  Supervision what;
  what.longest = std::chrono::minutes(14);  // a hang: ctest ends a test after 15
  for (Index i = 0; i < folders.size(); ++i) {
    const std::string id = std::to_string(i + 1);
    std::vector<std::string> peers{places::program("cairn-peers"), "--robot", id, "--bytes-per-second", "100000"};
    for (const std::string& word : network.peer_arguments(i)) peers.push_back(word);
    const int space = network.namespace_of(i);
    what.robots.push_back(
        {"robot_" + id,
         {{places::program("stand_in_core"), id, std::to_string(kRobots), std::to_string(kItems), "800"},
          folders[i],
          folders[i] / "core.log",
          space},
         {peers, folders[i], folders[i] / "peers.log", space}});
  }
  return what;
}

/// All robots know the same, and all of it.
void expect_agreement(const std::vector<fs::path>& folders) {
  std::set<std::string> known;
  for (const fs::path& folder : folders) known.insert(text_of(folder / "everything.txt"));
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(std::ranges::count(*known.begin(), '\n'), static_cast<std::ptrdiff_t>(kRobots * kItems));
}

Result<std::unique_ptr<Network>> tun_or_skip(const LinkConfig& link) { return make_tun_network(link, kRobots); }

TEST(TunNetwork, ABadRadioBringsEverythingToEveryone) {
  auto network = tun_or_skip({});
  if (!network) GTEST_SKIP() << to_string(network.error());
  const support::TemporaryFolder folder;
  const auto folders = robot_folders(folder.path());
  Supervision what = stand_ins(**network, folders);
  what.kills = plan_kills(1, kRobots, 1, std::chrono::seconds(3));
  const auto end = supervise(what, **network, LiveClock());
  ASSERT_TRUE(end);
  EXPECT_FALSE(end->stopped);
  expect_agreement(folders);
  for (Index i = 0; i < kRobots; ++i) {
    const auto& counted = (*network)->radio().counters(i);
    EXPECT_GT(counted.tx_bytes, 300 * kItems);
    EXPECT_NEAR(static_cast<double>(counted.lost), 0.2 * static_cast<double>(counted.tx_packets),
                0.1 * static_cast<double>(counted.tx_packets) + 10);
    EXPECT_EQ(end->robots[i].exit_code, 0) << text_of(folders[i] / "peers.log");
  }
}

TEST(LoopbackNetwork, ABadRadioBringsEverythingToEveryone) {
  const support::TemporaryFolder folder;
  const auto folders = robot_folders(folder.path());
  auto network = make_loopback_network({}, folders);
  ASSERT_TRUE(network);
  const auto end = supervise(stand_ins(**network, folders), **network, LiveClock());
  ASSERT_TRUE(end);
  EXPECT_FALSE(end->stopped);
  expect_agreement(folders);
  std::uint64_t sent = 0, lost = 0;  // of all: one robot may have sent too few for one to be lost
  for (Index i = 0; i < kRobots; ++i) {
    sent += (*network)->radio().counters(i).tx_packets;
    lost += (*network)->radio().counters(i).lost;
  }
  EXPECT_GT(lost, 0U) << "of " << sent;
  network->reset();
  for (const fs::path& robot : folders) EXPECT_FALSE(fs::exists(robot / "radio.sock"));
}

/// Processes whose command line begins with the program and works in a folder below `folder`.
std::size_t processes_in(const fs::path& folder) {
  std::size_t count = 0;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/proc", ignored)) {
    const fs::path cwd = fs::read_symlink(entry.path() / "cwd", ignored);
    count += !ignored && cwd.string().starts_with(folder.string()) ? 1U : 0U;
  }
  return count;
}

/// What runs a team is killed: no process is left, no namespace (they have no name and no other process), no socket.
TEST(TunNetwork, NothingIsLeftBehindAfterAKill) {
  if (const auto possible = tun_or_skip({}); !possible) GTEST_SKIP() << to_string(possible.error());
  const support::TemporaryFolder folder;
  const auto folders = robot_folders(folder.path());
  const pid_t program = ::fork();
  if (program == 0) {
    auto network = tun_or_skip({});
    Supervision what = stand_ins(**network, folders);
    for (RobotProcesses& robot : what.robots) robot.core.words[2] = "9";  // more robots than ever come
    (void)supervise(what, **network, LiveClock());
    ::_exit(0);
  }
  EXPECT_TRUE(becomes_true([&] { return processes_in(folder.path()) == 2 * kRobots; }));
  ::kill(program, SIGKILL);
  ::waitpid(program, nullptr, 0);
  EXPECT_TRUE(becomes_true([&] { return processes_in(folder.path()) == 0; }));
}

}  // namespace
}  // namespace cairn::team_run
