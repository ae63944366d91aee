// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/run.hpp"

#include <optional>
#include <system_error>

#include "onboard/app/checked_profile.hpp"
#include "onboard/app/commands/serve_commands.hpp"
#include "onboard/app/restart/restart.hpp"
#include "onboard/app/restart/start_log.hpp"
#include "onboard/app/restart/state_lock.hpp"
#include "onboard/app/run_output.hpp"
#include "onboard/app/runs/live_run.hpp"
#include "onboard/app/runs/replay_run.hpp"
#include "onboard/app/sight/open_sight.hpp"
#include "onboard/app/tasks/robot_tasks.hpp"
#include "onboard/app/team/join_team.hpp"

namespace cairn::app {
namespace {

/// The schedule of the options goes before the recording's own.
Result<void> take_schedule(const RunOptions& options, Door& door) {
  if (options.schedule.empty()) return {};
  auto log = scheduler::load_schedule_log(options.schedule);
  if (!log) return log.error();
  door.schedule = std::move(*log);
  return {};
}

/// Where it is missing.
Result<void> make_socket_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) return Error{Errc::kIo, "cannot make the folder for sockets", folder.string(), {}, failed.message()};
  return {};
}

Devices devices_for(const RunOptions& options, const RobotProfile& profile) {
  const bool shown = !options.sockets.empty();  // to clients
  return {.eyes = profile.sees_its_way(),
          .camera = shown || wants_camera(options, profile) || wants_eye(people::Eye::kVisible, options, profile),
          .thermal = shown || wants_eye(people::Eye::kThermal, options, profile),
          .depth = shown || profile.depth.map.rate_hz > 0,
          .all = !options.record.empty()};
}

Result<Door> open_door(const RunOptions& options, RobotProfile& profile, const Clock& clock, Monitor& monitor) {
  auto door = options.recording.empty() ? open_devices(profile, devices_for(options, profile), clock, monitor)
              : options.peers           ? play_recording(options.recording, profile, clock, monitor)
                                        : open_recording(options.recording, profile, monitor);
  if (!door) return door;
  if (options.recording.empty()) door->recording.profile = options.config.filename().string();
  if (const auto taken = take_schedule(options, *door); !taken) return taken.error();
  if (options.live() && !options.recording.empty()) forget_recorded(recording::kCommands, *door);
  if (const auto made = make_socket_folder(options.sockets); !made) return made.error();
  if (options.live() && !options.sockets.empty())
    if (const auto served = serve_commands(options.sockets, profile, clock, *door); !served) return served.error();
  if (options.peers)
    if (const auto joined = join_team(profile, clock, *door); !joined) return joined.error();
  return door;
}

/// Keeps other cores out of the state folder. A folder that cannot be locked is an event, and does not keep the robot
/// from starting; another core in it does (kLimit).
Result<std::optional<StateLock>> lock_state(const RunOptions& options, Time now, Monitor& monitor) {
  if (!options.live() || options.state.empty()) return std::optional<StateLock>();
  auto lock = StateLock::take(options.state);
  if (lock) return std::optional(std::move(*lock));
  if (lock.error().code == Errc::kLimit) return lock.error();
  monitor.event(now, "saved map", to_string(lock.error()));
  return std::optional<StateLock>();
}

/// The state folder of a live run. A fault in it must not keep the robot from starting.
struct StateFolder {
  StateFolder(const std::filesystem::path& folder, Monitor& monitor)
      : generations(folder, monitor), starts(folder / "starts.txt") {}
  Generations generations;
  StartLog starts;
};

PreviousRun find_previous_run(StateFolder& state, const RobotProfile& profile, Time now, Monitor& monitor) {
  PreviousRun previous = find_previous_run(state.generations, profile.restart,
                                           {profile.mapping.resolution_m, profile.sees_its_way()}, now, monitor);
  previous.crash_loop = state.starts.begin(now, boot_id());
  return previous;
}

/// What a replay goes on from: what the live run that made the recording went on from.
PreviousRun recorded_previous_run(const std::filesystem::path& recording, Monitor& monitor) {
  PreviousRun previous;
  previous.resumed = resumed_in_recording(recording, monitor);
  return previous;
}

}  // namespace

Result<std::unique_ptr<RunResult>> run(const RunOptions& options) {
  auto chosen = checked_profile(options);  // every fault at once, or valid
  if (!chosen) return chosen.error();
  RobotProfile* const profile = &chosen->profile;
  const bool live = options.live();
  auto results = prepare_output(options.out);
  if (!results) return results.error();
  auto result = std::make_unique<RunResult>();
  for (const std::string& note : chosen->notes) result->monitor.event({}, "profile", note);
  declare_stages(profile->schedule, profile->sees_its_way(), result->monitor);
  const LiveClock clock;
  const auto lock = lock_state(options, clock.now(), result->monitor);  // held to the end of the run
  if (!lock) return lock.error();
  auto door = open_door(options, *profile, clock, result->monitor);  // live devices, or a recording
  if (!door) return door.error();

  std::optional<StateFolder> state;
  if (live && !options.state.empty()) state.emplace(options.state, result->monitor);
  PreviousRun previous = state  ? find_previous_run(*state, *profile, clock.now(), result->monitor)
                         : live ? PreviousRun()
                                : recorded_previous_run(options.recording, result->monitor);
  auto sight = open_sight(options, *profile, chosen->file, door->recording.sources, result->monitor);
  if (!sight) return sight.error();
  RobotTasks tasks(door->recording.sources, *profile, options, previous, *std::move(sight), result->monitor);
  const RunContext context{*door, *profile, options, previous, result->monitor, results->path()};
  LiveRun live_run(tasks, context, clock);
  const auto ran = live ? live_run.run(state ? &state->generations : nullptr)  // packets → scans → poses and map
                        : replay_recording(tasks, context);
  if (!ran) return ran.error();
  if (state) state->starts.end();

  auto output = write_output(
      {options, *profile, chosen->file, tasks, *door, result->monitor, *ran, live_run.lost_schedule()}, *results);
  if (!output) return output.error();
  result->report = std::move(output->report);
  result->folder = std::move(output->folder);
  return result;
}

}  // namespace cairn::app
