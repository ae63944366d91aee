// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/team_tasks.hpp"

#include "onboard/app/profile/robot_profile.hpp"

namespace cairn {
namespace {

// What finds no place stays with the mapping and goes with the next batch.
constexpr std::size_t kWaitingBatches = 4;
// One is out at a time; its place may be given back a little after its result is there.
constexpr std::size_t kWaitingJobs = 2;

}  // namespace

TeamTasks::TeamTasks(scheduler::Executive& executive, const RobotProfile& profile, const scheduler::Line& mapping,
                     std::size_t tiles_slot, Monitor& monitor)
    : team_line_(executive.add(profile.schedule.team)),
      match_line_(executive.add(profile.schedule.matching)),
      tiles_({kWaitingBatches, 3 * kWaitingBatches, tiles_slot, TeamTask::kTilesSlot}, mapping.progress,
             team_line_.progress),
      jobs_({kWaitingJobs, kWaitingJobs, TeamTask::kJobsSlot, MatchTask::kJobsSlot}, team_line_.progress,
            match_line_.progress),
      results_({kWaitingJobs, kWaitingJobs, MatchTask::kResultsSlot, TeamTask::kResultsSlot,
                from_seconds(profile.team.match_s)},
               match_line_.progress, team_line_.progress),
      team_(profile.team, profile.name, profile.mapping.resolution_m, {tiles_, jobs_, results_}, monitor),
      match_(from_seconds(profile.team.match_s), jobs_, results_, monitor) {
  team_line_.task = &team_;
  match_line_.task = &match_;
  team_line_.input = true;
  team_line_.from = {&tiles_, &results_};
  match_line_.from = {&jobs_};
}

}  // namespace cairn
