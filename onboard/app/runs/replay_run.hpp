// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/runs/run_context.hpp"
#include "onboard/app/tasks/robot_tasks.hpp"

namespace cairn::app {

/// Runs the tasks on the recording behind the door, at the pace of the options: with the schedule log of the live run
/// where there is one, otherwise in virtual time. The options' `stop` ends it before the next tick; what the tasks had
/// by then is brought to its end. An event says when the recording lacks packets that the live run had. Errors: the
/// inputs cannot be connected; the log is of another schedule.
Result<RunEnd> replay_recording(RobotTasks& tasks, const RunContext& context);

}  // namespace cairn::app
