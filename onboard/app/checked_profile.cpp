// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/checked_profile.hpp"

#include <algorithm>
#include <thread>

#include "hal/files/unfinished_folder.hpp"
#include "onboard/app/door/devices.hpp"
#include "onboard/app/sight/open_mounts.hpp"
#include "onboard/app/sight/open_people.hpp"
#include "onboard/app/sight/open_perception.hpp"
#include "onboard/app/team/join_team.hpp"
#include "onboard/scheduler/task_spec.hpp"

namespace cairn::app {
namespace {

Result<void> check_live(const RunOptions& options, const RobotProfile& profile) {
  if (auto fits = check_schedule(options, profile); !fits) return fits;
  if (options.peers)
    if (auto place = check_team_place(profile); !place) return place;
  if (!options.recording.empty()) return {};
  if (auto fits = check_devices(profile); !fits) return fits;
  return check_drivers(profile);
}

/// The results of a replay have names that a recording has, too.
Result<void> check_output(const RunOptions& options) {
  if (options.recording.empty() || !lies_in(options.out, options.recording)) return {};
  return Error{Errc::kInvalidConfig,
               "the results would lie in the recording",
               options.out.string(),
               {},
               "name another --out, outside " + options.recording.string()};
}

}  // namespace

Result<void> check_schedule(const RunOptions& options, const RobotProfile& profile) {
  const auto tasks = profile.schedule.tasks({.team = profile.team.id != 0,
                                             .perception = wants_camera(options, profile),
                                             .depth = profile.depth.exists() && profile.depth.map.rate_hz > 0,
                                             .detection = wants_eye(people::Eye::kVisible, options, profile),
                                             .thermal_detection = wants_eye(people::Eye::kThermal, options, profile),
                                             .mount = wants_mounts(options, profile),
                                             .stereo = profile.sees_its_way()});
  return scheduler::validate(tasks, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
}

Result<ChosenProfile> checked_profile(const RunOptions& options) {
  if (const auto fits = check(options); !fits) return fits.error();
  if (const auto fits = check_output(options); !fits) return fits.error();
  auto chosen = choose_profile(options.config, options.recording);
  if (!chosen) return chosen.error();
  if (options.threads) chosen->profile.threads = *options.threads;
  if (options.live())
    if (const auto fits = check_live(options, chosen->profile); !fits) return fits.error();
  return chosen;
}

}  // namespace cairn::app
