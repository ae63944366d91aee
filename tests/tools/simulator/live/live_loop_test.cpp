// SPDX-License-Identifier: Apache-2.0
// The whole loop of programs on one machine: a client commands the core, the core commands the motors on a bus, the
// wheels move the body, and the LiDAR shows the core the world. It takes place in real time.
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>
#include <vector>

#include "drivers/clients/commands/command_client.hpp"
#include "drivers/recording/formats/trajectory_file.hpp"
#include "tests/faults/cairn_child.hpp"
#include "tests/support/own_address.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::simulator {
namespace {

using clients::Answer;
using clients::Command;
using clients::CommandClient;
using faults::CairnChild;
using namespace std::chrono_literals;

/// Tries until it is so; gives up after five minutes, as only a fault makes it.
bool becomes_true(const std::function<bool()>& is_so) {
  const LiveClock clock;
  for (const Time last = clock.now() + 5min; clock.now() < last;) {
    if (is_so()) return true;
    (void)::poll(nullptr, 0, 20);
  }
  return false;
}

class FullLiveLoop : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const char* name) const { return (folder / name).string(); }
  void SetUp() override {
    world.emplace(
        std::vector<std::string>{"simulate", "--live", "--scene", "carpark", "--start", "9,24,2.9", "--to",
                                 support::own_address(), "--can", "unix:" + path("can"), "--estop", path("estop"),
                                 "--truth", path("truth.tum"), "--profile-out", path("robot.yaml")},
        folder / "world.log");
    ASSERT_TRUE(becomes_true([&] { return std::filesystem::exists(folder / "robot.yaml"); })) << world->said();
    core.emplace(std::vector<std::string>{"run", "--config", path("robot.yaml"), "--sockets", folder.path().string(),
                                          "--record", path("recording"), "--out", path("run")},
                 folder / "core.log");
    ASSERT_TRUE(becomes_true([&] {
      auto connected = CommandClient::connect(folder / "command.sock", "test", clock);
      if (connected) client.emplace(std::move(*connected));
      return connected.has_value();
    })) << core->said();
  }
  /// Whether it can be armed now.
  bool arm() {
    const auto answer = client->arm(10s);
    return answer && answer->outcome == Answer::Outcome::kDone;
  }
  /// Commands a velocity until the drive has been told it `times` times; arms it again where a busy machine stops it.
  bool drive(double v, double w, int times) {
    return becomes_true([&] {
      const auto answer = client->ask(
          {.verb = Command::Verb::kVelocity, .valid_for = Command::kMostValid, .v = v, .w = w, .who = {}}, 10s);
      if (answer && answer->outcome == Answer::Outcome::kDone) return --times <= 0;
      if (answer && answer->stopped) (void)arm();
      return false;
    });
  }
  void press(bool pressed) const { std::ofstream(folder / "estop") << (pressed ? "0\n" : "1\n"); }
  static int end(CairnChild& child) {
    child.signal(SIGINT);
    return child.wait();
  }
  [[nodiscard]] std::string hash_of(const char* run) const {
    return nlohmann::json::parse(std::ifstream(folder / run / "report.json"), nullptr, false)["output_sha256"];
  }

  support::TemporaryFolder folder;
  LiveClock clock;
  std::optional<CairnChild> world, core;
  std::optional<CommandClient> client;
};

/// A busy machine may stop the robot in the middle; then it begins a new square where it stands.
TEST_F(FullLiveLoop, TheSquareOfTheExampleIsASquareInTheWorld) {
  client.reset();  // one program at a time commands
  std::string corners;
  ASSERT_TRUE(becomes_true([&] {
    CairnChild square({folder.path().string(), "0.8"}, folder / "square.log", "drive_square");
    EXPECT_TRUE(becomes_true([&] { return square.ended(); }));
    if (square.wait() == 0) corners = square.said();
    return !corners.empty();
  })) << core->said();
  EXPECT_EQ(end(*core), 0) << core->said();
  EXPECT_EQ(end(*world), 0) << world->said();
  const auto truth = recording::read_tum(folder / "truth.tum").value();
  const auto pose_at = [&](Time t) {
    return std::ranges::lower_bound(truth, t, {}, &recording::StampedPose::stamp)->pose;
  };
  std::istringstream lines(corners);
  std::vector<SE3> reached;
  for (std::string line; std::getline(lines, line);) reached.push_back(pose_at(Time(Duration(std::stoll(line)))));
  ASSERT_EQ(reached.size(), 4U) << corners;
  for (std::size_t i = 1; i < reached.size(); ++i) {
    const Vector6 side = (reached[i - 1].inverse() * reached[i]).xyz_rpy();
    EXPECT_NEAR(side[0], 0.8, 0.15) << corners;
    EXPECT_NEAR(side[1], 0, 0.15) << corners;
    EXPECT_NEAR(side[5], std::numbers::pi / 2, 2 * std::numbers::pi / 180) << corners;
  }
}

TEST_F(FullLiveLoop, DrivesStopsAndIsItsReplay) {
  ASSERT_TRUE(becomes_true([&] { return arm(); })) << core->said();
  EXPECT_TRUE(drive(0.4, 0.3, 60));
  press(true);
  EXPECT_TRUE(becomes_true([&] {
    const auto answer = client->ask({.verb = Command::Verb::kHold, .who = {}}, 10s);
    return answer && answer->stopped;
  }));
  EXPECT_FALSE(arm()) << "the button is still pressed";
  press(false);
  EXPECT_TRUE(becomes_true([&] { return arm(); }));
  EXPECT_TRUE(drive(-0.4, 0, 60));
  EXPECT_EQ(end(*core), 0) << core->said();
  EXPECT_EQ(end(*world), 0) << world->said();

  const auto truth = recording::read_tum(folder / "truth.tum").value();
  double way = 0;
  for (std::size_t i = 1; i < truth.size(); ++i)
    way += (truth[i].pose.translation() - truth[i - 1].pose.translation()).norm();
  EXPECT_GT(way, 0.5) << world->said();
  EXPECT_FALSE(std::filesystem::exists(folder / "can"));

  CairnChild replay({"run", "--recording", path("recording"), "--out", path("replay"), "--speed", "max"},
                    folder / "replay.log");
  ASSERT_EQ(replay.wait(), 0) << replay.said();
  EXPECT_EQ(hash_of("replay"), hash_of("run"));
}

}  // namespace
}  // namespace cairn::simulator
