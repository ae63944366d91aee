// SPDX-License-Identifier: Apache-2.0
// The whole command, with scripts that stand in for the robots' programs.
#include "tools/cli/team/team_command.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "onboard/app/profile/robot_profile.hpp"
#include "tests/tools/cli/run_command.hpp"
#include "tests/tools/team/sample_team.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class TeamCommand : public testing::Test {
 protected:
  void prepare(const team_run::SampleTeam& sample) {
    for (const int robot : {1, 2}) {
      const std::string name = "robot_" + std::to_string(robot);
      sample.write_recording(folder / "recordings" / name, robot);
      sample.write_result(folder / "prepared" / name, robot);
    }
    // A core that has done its work already.
    script("core", "echo \"$@\" > arguments; cp ../../prepared/$(basename $PWD)/* .");
    script("peers", "exec tail -f /dev/null");
  }
  void script(const char* name, const std::string& text) const {
    std::ofstream(folder / name) << "#!/bin/sh\n" << text << '\n';
    fs::permissions(folder / name, fs::perms::owner_all);
  }
  Outcome team(std::vector<std::string> more = {}) {
    std::vector<std::string> words{
        "team", "--recordings", folder / "recordings", "--out",   folder / "out",   "--settle",
        "5",    "--core",       folder / "core",       "--peers", folder / "peers", "--loopback"};
    words.insert(words.end(), more.begin(), more.end());
    return run(add_team_command, words);
  }
  [[nodiscard]] std::string text_of(const fs::path& path) const {
    std::ifstream in(folder / path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  TemporaryFolder folder;
};

TEST_F(TeamCommand, SaysWhatTheTeamHasComeTo) {
  prepare({0.25});
  const Outcome outcome = team({"--json", "--link", "clean"});
  ASSERT_EQ(outcome.exit_code, app::kDone) << outcome.err;
  const auto json = outcome.json();
  EXPECT_EQ(json, nlohmann::json::parse(text_of("out/team.json")));
  ASSERT_EQ(json["robots"].size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& robot = json["robots"][i];
    EXPECT_EQ(robot["name"], "robot_" + std::to_string(i + 1));
    EXPECT_EQ(robot["team_sha256"], "abc");
    EXPECT_EQ(robot["raw_bytes"], team_run::SampleTeam::kPackets * team_run::SampleTeam::kBytes);
    EXPECT_NEAR(robot["pose_error_m"][0], 0.25, 1e-9);
    EXPECT_NEAR(robot["pose_error_deg"][0], 0, 1e-9);
    EXPECT_EQ(robot["merged_with"][0], "robot_" + std::to_string(2 - i));
    EXPECT_EQ(robot["missed_ticks"], 11 + i);
    EXPECT_EQ(robot["tx_bytes"], 0);
  }
  EXPECT_EQ(json["wrong_merges"], 0);
  EXPECT_GT(json["iou_world"], 0.0);
  EXPECT_EQ(json["link"]["loss"], 0);
  EXPECT_THAT(text_of("out/team.png"), HasSubstr("PNG"));
}

TEST_F(TeamCommand, TellsEachCoreWhoItIsAndWhatToDo) {
  prepare({});
  ASSERT_EQ(team({"--resolution", "0.4"}).exit_code, app::kDone);
  for (const std::string robot : {"robot_1", "robot_2"}) {
    EXPECT_EQ(text_of("out/" + robot + "/arguments"), "run --config profile.yaml --recording " +
                                                          (folder / "recordings" / robot).string() +
                                                          " --peers --seconds 6.9 --out .\n");
    const auto profile = app::load_profile(folder / "out" / robot / "profile.yaml");
    ASSERT_TRUE(profile) << to_string(profile.error());
    EXPECT_EQ(profile->name, robot);
    EXPECT_EQ(std::to_string(profile->team.id), robot.substr(6));
    EXPECT_EQ(profile->team.socket, "peers.sock");
    EXPECT_EQ(profile->mapping.resolution_m, 0.4);
  }
}

TEST_F(TeamCommand, ForPeopleItIsATable) {
  prepare({});
  const Outcome outcome = team();
  EXPECT_THAT(outcome.out, HasSubstr("robot_2 (0.000 m, 0.00 deg)"));
  EXPECT_THAT(outcome.out, HasSubstr("0 wrong merges"));
  EXPECT_THAT(outcome.out, HasSubstr("robot_1 missed 11 of 511 ticks"));
}

TEST_F(TeamCommand, WithoutTruthItSaysWhatItDoesNotKnow) {
  team_run::SampleTeam sample;
  sample.truth = false;
  prepare(sample);
  const auto json = team({"--json"}).json();
  for (const char* field : {"wrong_merges", "iou_world"}) EXPECT_TRUE(json[field].is_null()) << field;
  EXPECT_TRUE(json["robots"][0]["pose_error_m"][0].is_null());
  const Outcome table = team({"--overwrite"});
  EXPECT_EQ(table.exit_code, app::kDone);
  EXPECT_THAT(table.out, HasSubstr("no truth"));
}

TEST_F(TeamCommand, FailsWhereMergedRobotsHaveDifferentMaps) {
  team_run::SampleTeam sample;
  sample.sha_2 = "def";
  prepare(sample);
  const Outcome outcome = team();
  EXPECT_EQ(outcome.exit_code, app::kFailed);
  EXPECT_THAT(outcome.out, HasSubstr("DIFFERENT team maps: robot_1 and robot_2"));
}

TEST_F(TeamCommand, FailsAfterAWrongMerge) {
  prepare({5});
  const Outcome outcome = team({"--json"});
  EXPECT_EQ(outcome.exit_code, app::kFailed);
  EXPECT_EQ(outcome.json()["wrong_merges"], 1);
}

TEST_F(TeamCommand, RobotsThatDidNotMeetAreNoFailure) {
  team_run::SampleTeam sample{5, "abc", "def"};
  sample.merged = false;
  prepare(sample);
  const Outcome outcome = team();
  EXPECT_EQ(outcome.exit_code, app::kDone) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("nobody"));
}

TEST_F(TeamCommand, ACoreThatFailsIsNamedWithItsLog) {
  prepare({});
  // The first robot's works until it is asked to end, for the second one's failure.
  script("core", "[ $(basename $PWD) = robot_1 ] && exec tail -f /dev/null; echo help; exit 3");
  const Outcome outcome = team();
  EXPECT_EQ(outcome.exit_code, app::kFailed);
  EXPECT_THAT(outcome.err, HasSubstr("a robot's core failed"));
  EXPECT_THAT(outcome.err, HasSubstr("robot_2"));
  EXPECT_THAT(outcome.err, HasSubstr("exit code 3, last words: help ("));
  EXPECT_THAT(outcome.err, HasSubstr("core.log"));
}

TEST_F(TeamCommand, WhatAnEarlierRunLeftIsNotTakenForThisOnes) {
  prepare({});
  ASSERT_EQ(team().exit_code, app::kDone);
  script("core", "exit 0");
  EXPECT_EQ(team({"--overwrite"}).exit_code, app::kFailed);
}

TEST_F(TeamCommand, AFolderThatIsInUseIsRefusedOrReplaced) {
  prepare({});
  ASSERT_EQ(team().exit_code, app::kDone);
  std::ofstream(folder / "out" / "notes.txt") << "mine";
  const Outcome refused = team();
  EXPECT_EQ(refused.exit_code, app::kFailed);
  EXPECT_THAT(refused.err, HasSubstr("already exists and is not an empty folder"));
  EXPECT_THAT(refused.err, HasSubstr("--overwrite"));
  EXPECT_EQ(team({"--overwrite"}).exit_code, app::kDone);
  EXPECT_EQ(text_of("out/notes.txt"), "mine");
}

TEST_F(TeamCommand, RefusesToWriteIntoRecordings) {
  prepare({});
  const Outcome outcome =
      run(add_team_command, {"team", "--recordings", folder / "recordings", "--out", folder / "recordings", "--core",
                             folder / "core", "--peers", folder / "peers"});
  EXPECT_EQ(outcome.exit_code, app::kWrongArguments);
  EXPECT_TRUE(fs::exists(folder / "recordings" / "robot_1" / "lidar.pcap"));
}

TEST_F(TeamCommand, WrongArgumentsAreSaid) {
  prepare({});
  EXPECT_EQ(team({"--link", "nowhere.yaml"}).exit_code, app::kWrongArguments);
  std::ofstream(folder / "link.yaml") << "loss: 2\n";
  EXPECT_EQ(team({"--link", folder / "link.yaml"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(team({"--settle", "-1"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(team({"--core", folder / "no_such_program"}).exit_code, app::kWrongArguments);
}

}  // namespace
}  // namespace cairn::cli
