// SPDX-License-Identifier: Apache-2.0
// A live core whose clients are killed at random instants, programs of ROS among them: it notices nothing but their
// absence.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "hal/clock.hpp"
#include "hal/workers.hpp"
#include "onboard/app/run.hpp"
#include "onboard/client/robot_stream.hpp"
#include "tests/support/loopback_lidar.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/vlp16_drive.hpp"
#include "tests/tools/ros/process/ros_rig.hpp"

namespace cairn::ros {
namespace {

constexpr double kDriven_s = 6;
constexpr int kFirst = 9;  // kills after which the core has opened all that it needs
const Vector6 kKilledMount = (Vector6() << 0.2, 0, 0.6, 0, 0, 0).finished();

/// How many files this program has open.
std::ptrdiff_t open_files() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

class ClientKills : public ::testing::Test {
 protected:
  ClientKills() {
    std::ofstream(folder_ / "robot.yaml") << support::LoopbackLidar::profile("[0.2, 0, 0.6, 0, 0, 0]");
    std::filesystem::create_directory(folder_ / "s");
    options_.config = folder_ / "robot.yaml";
    options_.out = folder_ / "live";
    options_.sockets = folder_ / "s";
    options_.pace = app::Pace::kLive;
    options_.progress = [this](Time, std::size_t scans) { scans_ = scans; };
    options_.stop = [this] { return done_.load(); };
  }

  /// A core runs; `kills` clients are started and killed after 0 to 120 ms, one after the other.
  void run(int kills) {
    const support::Vlp16Drive drive(support::lobby(), SE3::from_xyz_rpy(kKilledMount), kDriven_s, 1);
    Workers three(3);
    three.for_each(3, [&](std::size_t side) {
      if (side == 0) {
        result_ = app::run(options_);
        done_ = true;
        serve();
      } else if (side == 1) {
        serving_.wait(false);
        support::LoopbackLidar().send(drive.packets(), [this] { return done_.load(); });
      } else {
        kill_clients(kills);
        done_ = true;
        serve();
      }
    });
  }

  support::TemporaryFolder folder_;
  app::RunOptions options_;
  std::atomic<bool> done_ = false;
  Result<std::unique_ptr<app::RunResult>> result_ = Error{Errc::kNotFound, "the run has not begun"};
  std::ptrdiff_t files_before_ = 0, files_after_ = 0;

 private:
  void kill_clients(int kills) {
    const auto socket = options_.sockets / "robot.sock";
    clients::SubscribeMessage wants;
    wants.add(clients::Stream::kState);
    auto watcher = client::RobotStream::connect(socket, wants);
    for (const LiveClock clock; !watcher && !done_; watcher = client::RobotStream::connect(socket, wants))
      LiveClock::wait_until(clock.now() + std::chrono::milliseconds(10));
    ASSERT_TRUE(watcher);
    EXPECT_TRUE(speaks(*watcher));
    serve();
    std::mt19937 random(7);
    for (int i = 0; i < kills && !done_; ++i) {
      kill_one(i, std::chrono::milliseconds(random() % 120));
      if (i == kFirst) files_before_ = open_files();
    }
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(speaks(*watcher)) << "after all of them died";
    wait_for([&] { return scans_ > 0; });
    wait_for([&] { return open_files() <= files_before_; });
    files_after_ = open_files();
  }
  static bool speaks(client::RobotStream& watcher) {
    const auto next = watcher.next(kHang);
    return next && !std::holds_alternative<std::monostate>(*next);
  }
  template <class Condition>
  static void wait_for(Condition met) {
    const LiveClock clock;
    for (const Time end = clock.now() + kHang; !met() && clock.now() < end;)
      LiveClock::wait_until(clock.now() + std::chrono::milliseconds(10));
  }
  /// The core listens to the LiDAR, or will never do so.
  void serve() {
    serving_ = true;
    serving_.notify_all();
  }
  void kill_one(int i, Duration after) {
    std::vector<std::string> words;
    if (i % 2 == 0)
      words = {"--socket",         options_.sockets / "robot.sock",
               "--command-socket", options_.sockets / "command.sock",
               "--namespace",      "husky",
               "--domain",         std::to_string(claim_.domain()),
               "--interface",      "lo"};
    else
      words = {"pose", "--socket", options_.sockets / "robot.sock", "--rate", "200", "--json"};
    RosProcess client(words, i % 2 == 0 ? "cairn-ros" : "cairn");
    LiveClock::wait_until(LiveClock().now() + after);
    (void)client.end(SIGKILL);
  }

  static constexpr Duration kHang = std::chrono::seconds(60);
  std::atomic<bool> serving_ = false;
  std::atomic<std::size_t> scans_ = 0;
  peer_link::DomainClaim claim_ = peer_link::DomainClaim::make().value();
};

void expect_nothing_noticed(const app::RunResult& ran) {
  EXPECT_EQ(ran.report.control_thread_allocations.value_or(0), 0U);
  EXPECT_GT(ran.report.scans, 0U);
  for (const Event& event : ran.monitor.events()) EXPECT_NE(event.stage, "clients") << event.what;
}

TEST_F(ClientKills, TheCoreNoticesNothingButTheirAbsence) {
  run(24);
  ASSERT_TRUE(result_) << to_string(result_.error());
  expect_nothing_noticed(**result_);
  EXPECT_LE(files_after_, files_before_);
}

using FullClientKills = ClientKills;
TEST_F(FullClientKills, AThousandTimes) {
  run(1000);
  ASSERT_TRUE(result_) << to_string(result_.error());
  expect_nothing_noticed(**result_);
  EXPECT_LE(files_after_, files_before_);
}

}  // namespace
}  // namespace cairn::ros
