// SPDX-License-Identifier: Apache-2.0
#include "tools/team/supervisor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/team/shell.hpp"

namespace cairn::team {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

/// Robots that have nothing to say.
class Silence final : public Network {
 public:
  explicit Silence(Index robots) : radio_(LinkConfig{}, robots) {}
  [[nodiscard]] std::string_view kind() const override { return "silence"; }
  [[nodiscard]] int namespace_of(Index /*robot*/) const override { return -1; }
  [[nodiscard]] std::vector<std::string> peer_arguments(Index /*robot*/) const override { return {}; }
  void add_waits(std::vector<pollfd>& /*waits*/) const override {}
  void pump(Time /*now*/) override {}
  [[nodiscard]] const Radio& radio() const override { return radio_; }

 private:
  Radio radio_;
};

constexpr const char* kForever = "echo begun >> begun; exec tail -f /dev/null";

class Supervising : public testing::Test {
 protected:
  void add(const std::string& core, const std::string& peers = kForever) {
    const std::string name = "robot_" + std::to_string(what.robots.size() + 1);
    std::filesystem::create_directory(folder / name);
    what.robots.push_back({name, shell(core, folder / name), shell(peers, folder / name)});
    what.longest = seconds(60);
    what.say = [this](const std::string& line) { said += line + "\n"; };
  }
  TeamEnd run() {
    Silence network(what.robots.size());
    return supervise(what, network, LiveClock()).value();
  }
  /// How often the robot's peer process began.
  [[nodiscard]] std::size_t beginnings(const std::string& robot) const {
    const std::string text = text_of(folder / robot / "begun");
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  }

  support::TemporaryFolder folder;
  Supervision what;
  std::string said;
};

TEST_F(Supervising, EndsWhenAllCoresHaveAndTheirPeerProcessesWithThem) {
  add("until [ -e ../robot_1/begun ]; do :; done", "echo $$ > id; " + std::string(kForever));
  add("until [ -e ../robot_2/begun ]; do :; done", "echo $$ > id; " + std::string(kForever));
  const TeamEnd end = run();
  EXPECT_FALSE(end.stopped);
  for (const char* robot : {"robot_1", "robot_2"})
    EXPECT_NE(::kill(static_cast<pid_t>(std::stol(text_of(folder / robot / "id"))), 0), 0) << robot;
  for (const RobotEnd& robot : end.robots) {
    EXPECT_EQ(robot.exit_code, 0);
    EXPECT_EQ(robot.restarts, 0U);
  }
  EXPECT_EQ(said, "");
}

TEST_F(Supervising, StartsAPeerProcessAgainThatDiesAndSaysSo) {
  add("until [ \"$(wc -l < begun)\" = 2 ]; do :; done 2> /dev/null",
      "echo begun >> begun; [ \"$(wc -l < begun)\" = 1 ] && exit 9; exec tail -f /dev/null");
  const TeamEnd end = run();
  EXPECT_EQ(end.robots[0].exit_code, 0);
  EXPECT_EQ(end.robots[0].restarts, 1U);
  EXPECT_EQ(end.robots[0].kills, 0U);
  EXPECT_THAT(said, HasSubstr("robot_1: its peer process died (9) and is started again"));
}

TEST_F(Supervising, KillsPeerProcessesAsPlannedAndStartsThemAgain) {
  constexpr std::size_t kTimes = 10;
  for (int i = 0; i < 2; ++i) add("until [ -e ../end ]; do :; done");
  what.kills = plan_kills(1, 2, kTimes, milliseconds(1500));
  what.progress = [&](Duration age) {
    if (age > milliseconds(1700) && beginnings("robot_1") > kTimes / 2) std::ofstream(folder / "end") << "\n";
  };
  const TeamEnd end = run();
  for (const RobotEnd& robot : end.robots) {
    EXPECT_EQ(robot.exit_code, 0);
    EXPECT_EQ(robot.kills, kTimes);
    EXPECT_GT(robot.restarts, kTimes / 2);  // two kills may meet one process
    EXPECT_LE(robot.restarts, kTimes);
  }
  EXPECT_EQ(said, "");
}

TEST_F(Supervising, ACoreThatFailsEndsTheOthers) {
  add("exit 4");
  add("trap 'echo asked > asked; exit 0' TERM; echo begun > core; while :; do :; done");
  const TeamEnd end = run();
  EXPECT_TRUE(end.stopped);
  EXPECT_EQ(end.robots[0].exit_code, 4);
  EXPECT_THAT(said, HasSubstr("robot_1: its core failed (4)"));
  EXPECT_EQ(end.failed, 0U);
}

TEST_F(Supervising, TheCoreThatFailedIsToldFromOneThatWasEndedForIt) {
  add("exec tail -f /dev/null");
  add("exit 4");
  const TeamEnd end = run();
  EXPECT_EQ(end.failed, 1U);
  EXPECT_EQ(end.robots[0].exit_code, 128 + SIGTERM);
  EXPECT_EQ(end.robots[1].exit_code, 4);
}

TEST_F(Supervising, AskedToEndItAsksTheCoresAndKillsWhoDoesNotListen) {
  add("trap 'exit 0' TERM; echo begun > core; while :; do :; done");
  add("trap '' TERM; echo begun > core; while :; do :; done");
  what.grace = milliseconds(300);
  what.stop = [&] {
    return std::filesystem::exists(folder / "robot_1" / "core") && std::filesystem::exists(folder / "robot_2" / "core");
  };
  const TeamEnd end = run();
  EXPECT_TRUE(end.stopped);
  EXPECT_EQ(end.robots[0].exit_code, 0);
  EXPECT_EQ(end.robots[1].exit_code, 128 + SIGKILL);
}

TEST_F(Supervising, CoresThatDoNotEndAreEnded) {
  add("exec tail -f /dev/null");
  what.longest = milliseconds(100);
  const TeamEnd end = run();
  EXPECT_TRUE(end.stopped);
  EXPECT_EQ(end.robots[0].exit_code, 128 + SIGTERM);
  EXPECT_FALSE(end.failed);
  EXPECT_THAT(said, HasSubstr("do not end by themselves"));
}

}  // namespace
}  // namespace cairn::team
