// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/result.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/app/profile/run_options.hpp"

namespace cairn::app {

/// All that can be said about a run before a device is opened or a file is written. The profile for these options; or
/// what does not fit: the options to each other, the profile, and of a live run the schedule on this machine, the
/// settings of the devices and the place in the team. Errors: kInvalidConfig, and those of choose_profile().
[[nodiscard]] Result<ChosenProfile> checked_profile(const RunOptions& options);

/// Whether this machine can run the tasks of a live run; see scheduler::validate(). The tasks of a recording, of the
/// state folder and of clients count whether the options ask for them or not: a profile fits, or it does not.
[[nodiscard]] Result<void> check_schedule(const RunOptions& options, const RobotProfile& profile);

}  // namespace cairn::app
