// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/drive/drive_command.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "drivers/clients/commands/command_packet.hpp"
#include "drivers/clients/commands/command_socket.hpp"
#include "hal/clock.hpp"
#include "hal/workers.hpp"
#include "tests/tools/cli/run_command.hpp"

namespace cairn::cli {
namespace {

using clients::Answer;
using clients::Command;
using ::testing::HasSubstr;

/// A core that gives every client this greeting, and this answer to every command; and what it was asked.
struct Core {
  Answer greeting{.epoch = 4, .stopped = false, .holder = {}, .why = {}},
      answer{.epoch = 4, .stopped = false, .holder = {}, .why = {}};
  std::vector<Command> asked{};

  void take(const Packet& packet, clients::CommandSocket& socket) {
    if (clients::is_joined(packet)) (void)socket.answer(packet.channel, greeting);
    const auto command = clients::decode_command(packet.payload());
    if (!command) return;
    asked.push_back(*command);
    Answer said = answer;
    said.number = command->number;
    said.v = command->v;
    (void)socket.answer(packet.channel, said);
  }
};

/// Runs the command against the core.
Outcome run_against(Core& core, std::vector<std::string> arguments) {
  const TemporaryFolder folder;
  const LiveClock clock;
  const auto socket = clients::CommandSocket::open(folder / "command.sock", SourceId{}, clock).value();
  arguments.insert(arguments.end(), {"--socket", folder / "command.sock"});
  Outcome outcome{};
  std::atomic<bool> done{false};
  std::atomic<int> chunk{0};
  Workers(2).for_each(2, [&](std::size_t) {
    if (chunk.fetch_add(1) == 0) {
      outcome = run(add_drive_commands, arguments);
      done = true;
    } else {
      Packet packet;
      while (!done)
        if (socket->next(packet, {}).value() == Poll::kPacket) core.take(packet, *socket);
    }
  });
  return outcome;
}

TEST(DriveCommands, ArmAsksWithTheEpochOfTheGreeting) {
  Core core;
  const Outcome o = run_against(core, {"arm"});
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  ASSERT_EQ(core.asked.size(), 1U);
  EXPECT_EQ(core.asked[0].verb, Command::Verb::kArm);
  EXPECT_EQ(core.asked[0].epoch, 4U);
}

TEST(DriveCommands, ARefusalIsShownWithItsReason) {
  Core core;
  core.answer.outcome = Answer::Outcome::kRefused;
  core.answer.why.append("e_stop_open");
  const Outcome o = run_against(core, {"arm"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.out, HasSubstr("cannot be armed: e_stop_open"));
}

TEST(DriveCommands, StopAndDisarmSayWhatTheyAre) {
  for (const auto& [name, verb] :
       {std::pair("stop", Command::Verb::kStop), std::pair("disarm", Command::Verb::kDisarm)}) {
    Core core;
    EXPECT_EQ(run_against(core, {name}).exit_code, app::kDone);
    ASSERT_EQ(core.asked.size(), 1U);
    EXPECT_EQ(core.asked[0].verb, verb);
  }
}

TEST(DriveCommands, DriveSaysAVelocityAgainAndAgainAndHoldsAtTheEnd) {
  Core core;
  const Outcome o = run_against(core, {"drive", "--v", "-0.25", "--seconds", "0.2", "--json"});
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  ASSERT_GE(core.asked.size(), 2U);
  EXPECT_EQ(core.asked.front().verb, Command::Verb::kVelocity);
  EXPECT_EQ(core.asked.front().v, -0.25);
  EXPECT_EQ(core.asked.back().verb, Command::Verb::kHold);
  const auto json = nlohmann::json::parse(o.out);
  EXPECT_EQ(json["outcome"], "done");
  EXPECT_EQ(json["v"], -0.25);
}

TEST(DriveCommands, AStoppedRobotIsNotDriven) {
  Core core;
  core.greeting.stopped = true;
  core.greeting.why.append("stop: e_stop_open");
  const Outcome o = run_against(core, {"drive", "--v", "0.3", "--seconds", "5"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("e_stop_open"));
  EXPECT_THAT(o.err, HasSubstr("cairn arm"));
  EXPECT_TRUE(core.asked.empty());
}

TEST(DriveCommands, OfAnOpenEStopTheyNameTheWayOn) {
  Core core;
  core.greeting.stopped = true;
  core.greeting.why.append("stop: estop_open");
  const Outcome o = run_against(core, {"drive", "--v", "0.3", "--seconds", "5"});
  EXPECT_THAT(o.err, HasSubstr("stopped by the e-stop: release it, then `cairn arm`"));
}

TEST(DriveCommands, ADriveThatFailsSaysWhyOnce) {
  Core core;
  core.answer.outcome = Answer::Outcome::kHeld;
  core.answer.why.append("hold: drive_not_ready");
  const Outcome o = run_against(core, {"drive", "--v", "0.3", "--seconds", "0.2"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_EQ(o.err, "the motors are being enabled: the robot waits\n");
  EXPECT_EQ(o.out, "");
  const Outcome json = run_against(core, {"drive", "--v", "0.3", "--seconds", "0.2", "--json"});
  EXPECT_EQ(nlohmann::json::parse(json.out)["outcome"], "held");
}

TEST(DriveCommands, WithoutACoreTheySaySo) {
  const TemporaryFolder folder;
  const Outcome o = run(add_drive_commands, {"stop", "--socket", folder / "none"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("no core serves this socket"));
  EXPECT_EQ(run(add_drive_commands, {"drive", "--v", "nan", "--seconds", "1"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(run(add_drive_commands, {"drive", "--v", "0.1"}).exit_code, app::kWrongArguments);
}

TEST(PlaceCommand, TellsTheCoreWhereTheRobotIs) {
  Core core;
  const Outcome o =
      run_against(core, {"place", "--frame", "robot_1", "--x", "2.5", "--y", "-1", "--yaw", "90", "--sigma", "0.25"});
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_THAT(o.out, HasSubstr("cairn doctor --peer all"));
  ASSERT_EQ(core.asked.size(), 1U);
  EXPECT_EQ(core.asked[0].verb, Command::Verb::kPlace);
  const clients::Placement& place = core.asked[0].place;
  EXPECT_EQ(place.frame.view(), "robot_1");
  EXPECT_EQ(place.x, 2.5);
  EXPECT_EQ(place.y, -1);
  EXPECT_NEAR(place.yaw, M_PI / 2, 1e-9);
  EXPECT_EQ(place.sigma_m, 0.25);
  EXPECT_NEAR(place.sigma_rad, 15 * M_PI / 180, 1e-9);
}

TEST(PlaceCommand, CanTakeItBack) {
  Core core;
  EXPECT_EQ(run_against(core, {"place", "--forget"}).exit_code, app::kDone);
  ASSERT_EQ(core.asked.size(), 1U);
  EXPECT_EQ(core.asked[0].place, clients::Placement{});
  EXPECT_EQ(run(add_drive_commands, {"place", "--forget", "--x", "1"}).exit_code, app::kWrongArguments);
}

TEST(PlaceCommand, SaysWhyItWasRefused) {
  Core core;
  core.answer.outcome = Answer::Outcome::kRefused;
  core.answer.why.append("this robot is in no team");
  const Outcome o = run_against(core, {"place", "--x", "1"});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.out, HasSubstr("not placed: this robot is in no team"));
  EXPECT_EQ(core.asked.at(0).place.frame.view(), "") << "the frame of start poses";
}

}  // namespace
}  // namespace cairn::cli
