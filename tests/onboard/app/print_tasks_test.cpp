// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/print_tasks.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "drivers/recording/formats/recording.hpp"
#include "onboard/app/profile/schedule_profile.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(PrintTasks, ALiveRunHasTasksForTheDiskAndChannelsBetweenTheOthers) {
  RunOptions options;
  options.state = "somewhere";
  const auto text = print_tasks(options);
  ASSERT_TRUE(text) << to_string(text.error());
  EXPECT_EQ(*text,
            "task           rate Hz  priority  core  soft ms  hard ms  deadline ms  role\n"
            "safety             500        80     -      0.2        1            2  input\n"
            "drive              500        75     -      0.2        1            2  input\n"
            "receive            100        60     -        1       10           20  input\n"
            "odometry           100        50     -       40       80          100  stage\n"
            "mapping            100         -     -       30       90          100  stage\n"
            "rejoin              10         -     -        -        -         2500  stage\n"
            "housekeeping        20         -     -        1        -         1000  live only\n"
            "saving              10         -     -        5        -         1000  live only\n"
            "watch               20         -     -      0.5        -         1000  live only\n"
            "\n"
            "from                 to                   capacity   lag ms\n"
            "receive.seen         safety.sensors             64       20\n"
            "safety.lines         receive.lines              64    0.001\n"
            "drive.status         safety.drive               64    0.001\n"
            "odometry.status      safety.odometry            64      200\n"
            "safety.decisions     drive.decisions            64        0\n"
            "drive.rearms         safety.rearms               8    0.001\n"
            "drive.wheels         odometry.wheels            64    0.001\n"
            "receive.scans        odometry.scans              4        0\n"
            "odometry.motions     mapping.motions             4        0\n"
            "mapping.rejoin_jobs  rejoin.jobs                 2        0\n"
            "rejoin.results       mapping.rejoined            2     2500\n");
}

TEST(PrintTasks, ClientsAreServedByATaskOfTheirOwn) {
  RunOptions options;
  EXPECT_THAT(print_tasks(options).value(), Not(HasSubstr("streams")));
  options.sockets = "somewhere";
  EXPECT_THAT(print_tasks(options).value(),
              HasSubstr("streams            400         -     -        -        -            5  live only\n"));
}

TEST(PrintTasks, AReplayHasNoneThatIsLiveOnly) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "data.csv") << "";
  recording::Recording index;
  index.robot = "husky_1";
  index.sources.push_back({"lidar", recording::kScans, "data.csv", "lidar", ""});
  ASSERT_TRUE(recording::save_recording(folder / ".", index));
  RunOptions options;
  options.recording = folder / ".";
  const auto text = print_tasks(options);
  ASSERT_TRUE(text) << to_string(text.error());
  EXPECT_THAT(*text, HasSubstr("mapping "));
  EXPECT_THAT(*text, Not(HasSubstr("live only")));
  options.recording = folder / "nowhere";
  EXPECT_FALSE(print_tasks(options));
}

class PrintTasksOf : public testing::Test {
 protected:
  Result<std::string> printed(const std::string& profile) {
    std::ofstream(folder / "robot.yaml") << profile << "\n";
    options.config = folder / "robot.yaml";
    return print_tasks(options);
  }
  support::TemporaryFolder folder;
  RunOptions options;
};

/// The schedule is checked before the tasks exist.
TEST_F(PrintTasksOf, EveryTaskOfALiveRunIsInTheScheduleThatIsChecked) {
  options.state = options.sockets = "somewhere";
  options.peers = true;
  ASSERT_TRUE(printed("team: {id: 1}"));
  std::set<std::string> checked, run;
  for (const scheduler::TaskSpec& task : ScheduleProfile().tasks({.team = true})) checked.insert(task.name);
  const auto json = tasks_as_json(options);
  for (const auto& task : (*json)["tasks"]) run.insert(task["name"].get<std::string>());
  EXPECT_EQ(checked, run);
  for (const std::string& name : run) {
    const auto refused = printed("team: {id: 1}\nschedule: {" + name + ": {core: 1023}}");
    ASSERT_FALSE(refused) << name;
    EXPECT_THAT(refused.error().detail, HasSubstr(name + ": core 1023, but this machine has"));
  }
}

TEST_F(PrintTasksOf, WhatARunRefusesBeforeItOpensADeviceIsRefused) {
  for (const char* profile :
       {"schedule: {odometry: {busy_hz: 100}}", "schedule: {odometry: {soft_ms: 60, hard_ms: 50}}",
        "lidar: {source_address: 192.168.1.300}", "lidar: {data_port: 2368, position_port: 2368}"}) {
    const auto refused = printed(profile);
    ASSERT_FALSE(refused) << profile;
    EXPECT_EQ(refused.error().code, Errc::kInvalidConfig) << profile;
  }
  EXPECT_TRUE(printed("name: husky"));
  options.schedule = "schedule.log";
  EXPECT_EQ(printed("name: husky").error().cause, "these options cannot be used in this kind of run");
}

TEST_F(PrintTasksOf, AsJsonTheyAreTheSame) {
  std::ofstream(folder / "robot.yaml") << "schedule: {mapping: {core: 0}}\n";
  options.config = folder / "robot.yaml";
  options.sockets = "somewhere";
  const auto json = tasks_as_json(options);
  ASSERT_TRUE(json) << to_string(json.error());
  const auto& mapping = (*json)["tasks"][4];
  EXPECT_EQ(mapping["name"], "mapping");
  EXPECT_EQ(mapping["core"], 0);
  EXPECT_EQ(mapping["soft_ms"], 30);
  EXPECT_EQ((*json)["tasks"].back()["name"], "streams");
  EXPECT_TRUE((*json)["tasks"].back()["soft_ms"].is_null());
  EXPECT_EQ((*json)["channels"][0].dump(),
            R"({"from":"receive.seen","to":"safety.sensors","capacity":64,"lag_ms":20.0})");
}

TEST(PrintTasks, ATeamHasTwoTasksMoreWhereTheProfileNamesAPlaceInIt) {
  const support::TemporaryFolder folder;
  RunOptions options;
  options.peers = true;
  const auto refused = print_tasks(options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidConfig);
  std::ofstream(folder / "robot.yaml") << "team: {id: 1}\n";
  options.config = folder / "robot.yaml";
  const auto text = print_tasks(options);
  ASSERT_TRUE(text) << to_string(text.error());
  for (const char* link :
       {"mapping.tiles        team.tiles", "team.jobs            matching.jobs", "matching.results     team.results"})
    EXPECT_THAT(*text, HasSubstr(link));
}

}  // namespace
}  // namespace cairn::app
