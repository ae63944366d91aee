// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/robot_tasks.hpp"

#include <gmock/gmock.h>

#include <map>

namespace cairn::app {
namespace {

using recording::SourceEntry;

std::vector<SourceEntry> sources(std::initializer_list<recording::SensorKind> kinds) {
  std::vector<SourceEntry> list;
  for (const recording::SensorKind kind : kinds) list.emplace_back().kind = kind;
  return list;
}

struct RobotTasksTest : ::testing::Test {
  std::vector<std::string> names(const RobotTasks& tasks) {
    std::vector<std::string> list;
    for (const auto& task : tasks.graph.tasks()) list.push_back(task.spec.name);
    return list;
  }
  RobotProfile profile;
  RunOptions options;
  PreviousRun previous;
  Monitor monitor;
};

/// Numbers that recordings of every version rely on: a changed one makes old schedule logs mean something else.
TEST_F(RobotTasksTest, TheSlotsInTheScheduleLogNeverChange) {
  const auto all = sources({recording::kVelodyne, recording::kPeers});
  const RobotTasks tasks(all, profile, options, previous, {}, monitor);
  const SafetyTask& safety = tasks.safety;
  const DriveTask& drive = tasks.drive;
  const TeamTask& team = tasks.team->team();
  const MatchTask& matching = tasks.team->matching();
  const std::map<std::string, std::vector<std::size_t>> numbers{
      {"safety",
       {safety.edges_slot, safety.level_slot, safety.sensors.slot(), safety.drive.slot(), safety.decisions.slot(),
        safety.rearms.slot(), safety.faults_slot, safety.odometry.slot()}},
      {"drive",
       {drive.can_slots.frames, drive.can_slots.full, drive.can_slots.down, drive.can_slots.errors,
        drive.decisions.slot(), drive.status.slot()}},
      {"receive", {tasks.receive.packets_slot, tasks.receive.scans.slot(), tasks.receive.seen.slot()}},
      {"odometry",
       {tasks.odometry->scans.slot(), tasks.odometry->steps_slot, tasks.odometry->motions.slot(),
        tasks.odometry->status.slot()}},
      {"mapping",
       {tasks.mapping.motions.slot(), tasks.mapping.shed_slot, tasks.mapping.tiles.slot(), tasks.mapping.mates.slot(),
        tasks.mapping.rejoin_jobs.slot(), tasks.mapping.rejoined.slot()}},
      {"team", {team.tiles.slot(), team.datagrams_slot, team.fuse_slot, team.jobs.slot(), team.results.slot()}},
      {"matching", {matching.jobs.slot(), matching.steps_slot, matching.results.slot()}},
      {"rejoin", {tasks.rejoin.jobs.slot(), tasks.rejoin.steps_slot, tasks.rejoin.results.slot()}}};
  const std::map<std::string, std::vector<std::size_t>> expected{{"safety", {0, 1, 2, 3, 4, 5, 6, 7}},
                                                                 {"drive", {0, 1, 2, 3, 4, 5}},
                                                                 {"receive", {0, 8, 9}},
                                                                 {"odometry", {0, 1, 2, 3}},
                                                                 {"mapping", {0, 1, 2, 7, 8, 9}},
                                                                 {"team", {0, 1, 2, 3, 4}},
                                                                 {"matching", {0, 1, 2}},
                                                                 {"rejoin", {0, 1, 2}}};
  EXPECT_EQ(numbers, expected);
  EXPECT_THAT(names(tasks),
              ::testing::ElementsAre("safety", "drive", "receive", "odometry", "mapping", "team", "matching", "rejoin"))
      << "their order decides which runs first when several are released together";
}

TEST_F(RobotTasksTest, ARobotWithoutPeersHasNoTeam) {
  const auto lidar = sources({recording::kVelodyne});
  options.reference = true;
  const RobotTasks tasks(lidar, profile, options, previous, {}, monitor);
  EXPECT_FALSE(tasks.team.has_value());
  EXPECT_THAT(names(tasks),
              ::testing::ElementsAre("safety", "drive", "receive", "odometry", "mapping", "rejoin", "reference"));
  EXPECT_TRUE(tasks.graph.tasks().back().live_only());
  EXPECT_FALSE(tasks.mapping.tiles.connected()) << "nobody takes tiles";
}

}  // namespace
}  // namespace cairn::app
