// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/clock.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::scheduler {

/// Tasks run on for so long after the last input has ended. No task of a replay runs further ahead of the inputs.
inline constexpr Duration kTail = std::chrono::milliseconds(30);

/// The release after which no task is released any more; Time::max() before all inputs have ended.
[[nodiscard]] Time stop_time(const TaskGraph& graph);

/// After the last tick of all tasks: every task uses what is left in its channels, then each hands on what it held
/// back. `clock`: live, for figures; null in a replay.
void drain(TaskGraph& graph, const Clock* clock);

}  // namespace cairn::scheduler
