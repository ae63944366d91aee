// SPDX-License-Identifier: Apache-2.0
#include "tools/team/supervisor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/tools/team/shell.hpp"

namespace cairn::team_run {
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
constexpr const char* kUntilEnd = "read -r line < end";  // a pipe

/// The supervisor's time is the test's: what is slow on a busy machine is not late.
class Supervising : public testing::Test {
 protected:
  /// Time passes until the supervisor has said something; then it stands, so that nothing is killed for being slow.
  Supervising() {
    clock.advance_to({});
    what.longest = std::chrono::hours(1);
    what.say = [this](const std::string& line) { said += line + "\n"; };
    what.progress = [this](Duration) {
      if (said.empty()) pass(milliseconds(20));
    };
  }
  void add(const std::string& core, const std::string& peers = kForever) {
    const std::string name = "robot_" + std::to_string(what.robots.size() + 1);
    std::filesystem::create_directory(folder / name);
    ASSERT_EQ(::mkfifo((folder / name / "end").c_str(), 0600), 0);
    what.robots.push_back({name, shell(core, folder / name), shell(peers, folder / name)});
  }
  TeamEnd run() {
    Silence network(what.robots.size());
    return supervise(what, network, clock).value();
  }
  void pass(Duration time) { clock.advance_to(clock.now() + time); }
  /// Lets a core end that waits for it.
  void end(const std::string& robot) const { std::ofstream(folder / robot / "end") << "\n"; }
  /// The process that left its number in the file has ended.
  [[nodiscard]] bool gone(const std::filesystem::path& file) const {
    const std::string id = text_of(file);
    return !id.empty() && ::kill(static_cast<pid_t>(std::stol(id)), 0) != 0;
  }
  /// How often the robot's peer process began.
  [[nodiscard]] std::size_t beginnings(const std::string& robot) const {
    const std::string text = text_of(folder / robot / "begun");
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  }

  support::TemporaryFolder folder;
  VirtualClock clock;
  Supervision what;
  std::string said;
};

TEST_F(Supervising, EndsWhenAllCoresHaveAndTheirPeerProcessesWithThem) {
  add("until [ -e ../robot_1/begun ]; do :; done", "echo $$ > id; " + std::string(kForever));
  add("until [ -e ../robot_2/begun ]; do :; done", "echo $$ > id; " + std::string(kForever));
  const TeamEnd end = run();
  EXPECT_FALSE(end.stopped);
  for (const char* robot : {"robot_1", "robot_2"}) EXPECT_TRUE(gone(folder / robot / "id")) << robot;
  for (const RobotEnd& robot : end.robots) {
    EXPECT_EQ(robot.exit_code, 0);
    EXPECT_EQ(robot.restarts, 0U);
  }
  EXPECT_EQ(said, "");
}

TEST_F(Supervising, StartsAPeerProcessAgainThatDiesAndSaysSo) {
  add(kUntilEnd, "echo begun >> begun; [ \"$(wc -l < begun)\" = 1 ] && exit 9; echo > end; exec tail -f /dev/null");
  const TeamEnd end = run();
  EXPECT_EQ(end.robots[0].exit_code, 0);
  EXPECT_EQ(end.robots[0].restarts, 1U);
  EXPECT_EQ(end.robots[0].kills, 0U);
  EXPECT_THAT(said, HasSubstr("robot_1: its peer process died (9) and is started again"));
}

TEST_F(Supervising, KillsPeerProcessesAsPlannedAndStartsThemAgain) {
  constexpr std::size_t kTimes = 10;
  for (int i = 0; i < 2; ++i) add(kUntilEnd);
  what.kills = plan_kills(1, 2, kTimes, milliseconds(1500));
  std::map<Index, std::size_t> begun{{0, 1}, {1, 1}};  // as often as by now
  std::size_t next = 0;
  what.progress = [&](Duration) {
    if (next > what.kills.size() || beginnings("robot_1") < begun[0] || beginnings("robot_2") < begun[1]) return;
    if (next == what.kills.size()) {
      for (const char* robot : {"robot_1", "robot_2"}) this->end(robot);
    } else {
      ++begun[what.kills[next].robot];
      clock.advance_to(Time{} + what.kills[next].after);
    }
    ++next;
  };
  const TeamEnd end = run();
  for (const RobotEnd& robot : end.robots) {
    EXPECT_EQ(robot.exit_code, 0);
    EXPECT_EQ(robot.kills, kTimes);
    EXPECT_EQ(robot.restarts, kTimes);
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
  add("trap 'exit 0' TERM; echo $$ > core; while :; do :; done");
  add("trap '' TERM; echo $$ > core; while :; do :; done");
  what.progress = [&](Duration) {
    if (gone(folder / "robot_1" / "core")) pass(what.grace);
  };
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
}  // namespace cairn::team_run
