// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/team_tasks.hpp"

#include "onboard/app/profile/robot_profile.hpp"

namespace cairn::app {
namespace {

// Tiles that find no place stay with mapping and go with the next batch.
constexpr std::size_t kWaitingBatches = 4;
// One is out at a time; its place may be given back a little after its result is there.
constexpr std::size_t kWaitingJobs = 2;
// Ten come in a second, and mapping takes them with each scan.
constexpr std::size_t kWaitingMates = 16;
// A person says one in a minute, satellites one in a second. A program may say one with each tick of the drive.
constexpr std::size_t kWaitingPlaces = 8;

}  // namespace

TeamTasks::TeamTasks(scheduler::TaskGraph& graph, const RobotProfile& profile, const Others& others, Monitor& monitor)
    : team_(profile.team, profile.name, profile.mapping.resolution_m, monitor),
      matching_(from_seconds(profile.team.match_s), monitor) {
  graph.add(profile.schedule.team, team_, scheduler::TaskRole::kInput);
  graph.add(profile.schedule.matching, matching_);
  graph.connect(others.tiles, team_.tiles, {.capacity = kWaitingBatches, .reserve = 3 * kWaitingBatches});
  graph.connect(team_.jobs, matching_.jobs, {.capacity = kWaitingJobs, .reserve = kWaitingJobs});
  graph.connect(matching_.results, team_.results,
                {.capacity = kWaitingJobs, .reserve = kWaitingJobs, .lag = from_seconds(profile.team.match_s)});
  graph.connect(others.places, team_.places, {.capacity = kWaitingPlaces, .lag = profile.schedule.drive.deadline()});
  graph.connect(others.fixes, team_.fixes, {.capacity = kWaitingPlaces, .lag = profile.schedule.receive.deadline()});
  graph.connect(team_.mates, others.mates, {.capacity = kWaitingMates, .lag = profile.schedule.team.deadline()});
}

}  // namespace cairn::app
