// SPDX-License-Identifier: Apache-2.0
// Kills the real program at random instants while it maps and saves, again and again. CAIRN_KILLS: how often the slow
// test does (10 without); CAIRN_RESTART_LIMIT_S: how long a restart may take until the first new pose is saved
// (without: it is only said).
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "hal/clock.hpp"
#include "hal/files/file.hpp"
#include "hal/workers.hpp"
#include "onboard/app/restart/generations.hpp"
#include "tests/faults/cairn_child.hpp"
#include "tests/support/loopback_lidar.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"

namespace cairn::faults {
namespace {

using namespace std::chrono_literals;

/// A standing robot's LiDAR, the same few seconds over and over: one that drove would jump back at their end.
class Lidar {
 public:
  void send_until(const std::atomic<bool>& stop) {
    while (!stop) wire_.send(drive_.packets(), [&stop] { return stop.load(); });
  }

 private:
  static support::Scene standing() {
    support::Scene scene = support::lobby();
    scene.ride.max_speed = 0;
    return scene;
  }
  support::LoopbackLidar wire_;
  support::Vlp16Drive drive_{standing(), SE3::from_xyz_rpy((Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished()), 5, 1};
};

long from_environment(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtol(text, nullptr, 10) : otherwise;
}

std::vector<std::byte> bytes_of(const std::filesystem::path& file) {
  auto bytes = read_file(file, 1 << 20);
  return bytes ? std::move(*bytes) : std::vector<std::byte>();
}

/// Until the file is another one, or there at all; false after four minutes, as only a fault makes it.
bool wait_for_change(const std::filesystem::path& file) {
  const LiveClock clock;
  const auto before = bytes_of(file);
  for (const Time begin = clock.now(); clock.now() - begin < 4min; LiveClock::wait_until(clock.now() + 5ms))
    if (const auto now = bytes_of(file); !now.empty() && now != before) return true;
  return false;
}

void write_profile(const std::filesystem::path& file) {
  std::ofstream(file) << support::LoopbackLidar::profile("[0.2, 0, 0.6, 0, 0, 0]")
                      << "mapping:\n  reserve_mb: 16\nrestart:\n  save_map_every_s: 1\n";
}

/// Kills a core at a random instant after its first new pose. Returns how long that one took.
Duration kill_one(const std::filesystem::path& folder, std::mt19937_64& random) {
  const LiveClock clock;
  const Time begin = clock.now();
  CairnChild core({"run", "--config", folder / "robot.yaml", "--state", folder / "state", "--out", folder / "out"},
                  folder / "said.txt");
  const std::filesystem::path state = folder / "state", map = state / app::Generations::kMapFiles.front();
  const bool pose = wait_for_change(state / app::Generations::kStateFile);
  const Duration restart = clock.now() - begin;
  if (!pose || (!std::filesystem::exists(map) && !wait_for_change(map))) {
    core.signal(SIGTERM);  // it says what happened to it
    (void)core.wait();
    ADD_FAILURE() << "no pose or no map. " << core.said();
    return {};
  }
  LiveClock::wait_until(clock.now() + std::chrono::microseconds(random() % 1'200'000));
  core.signal(SIGKILL);
  EXPECT_EQ(core.wait(), -SIGKILL) << "it ended by itself: " << core.said();
  return restart;
}

/// The newest map after a kill; `least`: the one before.
std::uint64_t newest_map(const std::filesystem::path& state, std::uint64_t least) {
  const auto monitor = std::make_unique<Monitor>();
  const auto newest = app::Generations(state, *monitor).load(Time{});
  for (const Event& e : monitor->events()) ADD_FAILURE() << e.what;
  const std::uint64_t sequence = newest ? newest->state.sequence : 0;
  EXPECT_GE(sequence, least) << "an older map than before";
  return sequence;
}

void kill_again_and_again(const std::filesystem::path& folder, long kills) {
  const long limit_s = from_environment("CAIRN_RESTART_LIMIT_S", 0);
  std::mt19937_64 random(1);
  std::uint64_t sequence = 0;
  std::vector<Duration> restarts;
  for (long i = 0; i < kills && !testing::Test::HasFailure(); ++i) {
    restarts.push_back(kill_one(folder, random));
    sequence = newest_map(folder / "state", sequence);
  }
  EXPECT_GT(sequence, 0U);
  std::sort(restarts.begin(), restarts.end());
  std::cout << kills << " kills, " << sequence << " generations; from the start until a new pose is saved: median "
            << to_milliseconds(restarts[restarts.size() / 2]) << " ms, worst " << to_milliseconds(restarts.back())
            << " ms\n";
  EXPECT_TRUE(limit_s == 0 || restarts.back() <= std::chrono::seconds(limit_s));
}

void expect_a_whole_map_after(long kills) {
  const support::TemporaryFolder folder;
  Lidar lidar;
  write_profile(folder / "robot.yaml");
  std::atomic<bool> done{false};
  Workers both(2);
  both.for_each(2, [&](std::size_t side) {
    if (side == 1) return lidar.send_until(done);
    kill_again_and_again(folder.path(), kills);
    done = true;
  });
}

TEST(KillCampaign, AWholeMapIsThereAfterEveryKill) { expect_a_whole_map_after(2); }
TEST(FullKillCampaign, AWholeMapIsThereAfterEveryKill) {
  expect_a_whole_map_after(from_environment("CAIRN_KILLS", 10));
}

}  // namespace
}  // namespace cairn::faults
