// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/print_tasks.hpp"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "hal/monitor.hpp"
#include "onboard/app/checked_profile.hpp"
#include "onboard/app/door/devices.hpp"
#include "onboard/app/sight/open_sight.hpp"
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

/// What `say` makes of the graph of the run.
template <class Say>
auto with_tasks(const RunOptions& options, Say say) -> Result<decltype(say(scheduler::TaskGraph()))> {
  const auto chosen = checked_profile(options);
  if (!chosen) return chosen.error();
  const RobotProfile& profile = chosen->profile;
  const auto sources = sources_of(options, profile);
  if (!sources) return sources.error();
  Monitor monitor;
  auto sight = open_sight(options, profile, chosen->file, *sources, monitor);
  if (!sight) return sight.error();
  RobotTasks tasks(*sources, profile, options, {}, std::move(*sight), monitor);
  if (options.live()) add_live_only_tasks(options, profile.schedule, tasks);
  return say(std::as_const(tasks.graph));
}

report::Json to_json(const scheduler::ScheduledTask& task) {
  const scheduler::TaskSpec& spec = task.spec;
  const auto declared = [](double value) { return value > 0 ? report::Json(value) : report::Json(nullptr); };
  return {{"name", spec.name},
          {"role", scheduler::to_string(task.role)},
          {"rate_hz", spec.rate_hz},
          {"priority", spec.priority},
          {"core", spec.core >= 0 ? report::Json(spec.core) : report::Json(nullptr)},
          {"soft_ms", declared(spec.soft_ms)},
          {"hard_ms", declared(spec.hard_ms)},
          {"deadline_ms", to_milliseconds(spec.deadline())}};
}

report::Json to_json(const scheduler::TaskGraph& graph) {
  report::Json tasks = report::Json::array(), channels = report::Json::array();
  for (const scheduler::ScheduledTask& task : graph.tasks()) tasks.push_back(to_json(task));
  for (const auto& channel : graph.connections())
    channels.push_back({{"from", channel.from},
                        {"to", channel.to},
                        {"capacity", channel.options.capacity},
                        {"lag_ms", to_milliseconds(channel.options.lag)}});
  return {{"tasks", std::move(tasks)}, {"channels", std::move(channels)}};
}

}  // namespace

Result<std::string> print_tasks(const RunOptions& options) {
  return with_tasks(options, [](const scheduler::TaskGraph& graph) { return graph.to_text(); });
}

Result<report::Json> tasks_as_json(const RunOptions& options) {
  return with_tasks(options, [](const scheduler::TaskGraph& graph) { return to_json(graph); });
}

}  // namespace cairn::app
