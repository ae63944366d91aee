// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/scheduler/execution/replay_schedule.hpp"

namespace cairn::scheduler {

/// Replays on the calling thread, as fast as possible: tick after tick in the order of their releases.
[[nodiscard]] ReplayEnd replay_serially(const ReplaySchedule& schedule);

}  // namespace cairn::scheduler
