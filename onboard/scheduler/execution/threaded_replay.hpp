// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/clock.hpp"
#include "onboard/scheduler/execution/replay_schedule.hpp"
#include "onboard/scheduler/execution/task_meter.hpp"

namespace cairn::scheduler {

/// Replays at real speed, every task on a thread of its own. Tasks that are live only run beside it on the machine's
/// clock. `start`: of virtual time, which begins now. The result is that of replay_serially(), unless it is
/// interrupted. It never diverges.
[[nodiscard]] ReplayEnd replay_on_threads(const ReplaySchedule& schedule, Time start, const Clock& clock,
                                          CountAllocations allocations);

}  // namespace cairn::scheduler
