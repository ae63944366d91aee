// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/app/runs/run_context.hpp"
#include "onboard/app/tasks/recorder.hpp"
#include "onboard/app/tasks/robot_tasks.hpp"

namespace cairn::app {

/// Gives every input of the door to the task that reads it: the e-stop to safety, the CAN bus to drive, peers to the
/// team, and all others to receive. An input beyond ReceiveTask::kMaxInputs is left out, with an event, and so is a CAN
/// bus of which the profile knows no drive. `recorder` gets every packet before it is used; null: nothing is recorded.
/// Both must outlive the tasks. Error kInvalidConfig: the drive cannot be set up.
Result<void> connect_inputs(RobotTasks& tasks, const RunContext& context, Recorder* recorder);

/// The arrival of the first packet of all inputs; Time::max(): there is none. After connect_inputs().
[[nodiscard]] Time first_arrival(RobotTasks& tasks);
/// Packets that the live run had and the recording lacks.
[[nodiscard]] std::uint64_t missing_packets(const RobotTasks& tasks);

}  // namespace cairn::app
