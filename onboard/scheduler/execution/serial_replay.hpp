// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/scheduler/execution/replay_schedule.hpp"
#include "onboard/scheduler/execution/silence.hpp"

namespace cairn::scheduler {

/// Replays on the calling thread, as fast as possible: tick after tick in the order of their releases. `silence`: what
/// virtual time jumps over; null, or with a log: nothing.
[[nodiscard]] ReplayEnd replay_serially(const ReplaySchedule& schedule, Silence* silence = nullptr);

}  // namespace cairn::scheduler
