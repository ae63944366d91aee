// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/monitor.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::app {

/// Locks the memory of the process and asks for what the priorities of the tasks need. Each thing that the machine
/// refuses is one event. False: the run goes on in best-effort mode.
bool become_real_time(const scheduler::TaskGraph& graph, Monitor& monitor);

}  // namespace cairn::app
