// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/print_tasks.hpp"

#include <utility>
#include <vector>

#include "hal/monitor.hpp"
#include "onboard/app/door/devices.hpp"
#include "onboard/app/perception/open_sight.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/app/tasks/robot_tasks.hpp"
#include "onboard/app/team/join_team.hpp"

namespace cairn::app {
namespace {

using Sources = std::vector<recording::SourceEntry>;

Result<Sources> sources_of(const RunOptions& options, const RobotProfile& profile) {
  Sources sources = devices_of(profile);
  if (!options.recording.empty()) {
    auto recorded = recording::load_recording(options.recording);
    if (!recorded) return recorded.error();
    sources = std::move(recorded->sources);
  }
  if (!options.peers) return sources;
  if (const auto place = check_team_place(profile); !place) return place.error();
  sources.push_back(peers_entry());
  return sources;
}

/// As LiveRun adds them.
void add_live_only_tasks(const RunOptions& options, const ScheduleProfile& schedule, RobotTasks& tasks) {
  std::vector<scheduler::TaskSpec> specs{schedule.housekeeping};
  if (!options.state.empty()) specs.push_back(schedule.saving);
  specs.push_back(schedule.watch);
  if (!options.sockets.empty()) specs.push_back(schedule.streams);
  for (const scheduler::TaskSpec& spec : specs) tasks.graph.add(spec, tasks.reference, scheduler::TaskRole::kLiveOnly);
}

}  // namespace

Result<std::string> print_tasks(const RunOptions& options) {
  const auto chosen = choose_profile(options.config, options.recording);
  if (!chosen) return chosen.error();
  const RobotProfile& profile = chosen->profile;
  const auto sources = sources_of(options, profile);
  if (!sources) return sources.error();
  Monitor monitor;
  auto sight = open_sight(options, profile, chosen->file, *sources, monitor);
  if (!sight) return sight.error();
  RobotTasks tasks(*sources, profile, options, {}, std::move(*sight), monitor);
  if (options.live()) add_live_only_tasks(options, profile.schedule, tasks);
  return tasks.graph.to_text();
}

}  // namespace cairn::app
