// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/print_tasks.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "drivers/recording/formats/recording.hpp"
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
