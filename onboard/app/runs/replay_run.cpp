// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/replay_run.hpp"

#include <string>

#include "onboard/app/runs/allocations.hpp"
#include "onboard/app/runs/connect_inputs.hpp"
#include "onboard/app/runs/real_time.hpp"
#include "onboard/app/runs/safety_events.hpp"
#include "onboard/scheduler/execution/executive.hpp"

namespace cairn::app {

Result<RunEnd> replay_recording(RobotTasks& tasks, const RunContext& context) {
  if (const auto connected = connect_inputs(tasks, context, nullptr); !connected) return connected.error();
  const LiveClock clock;
  const Time first = first_arrival(tasks);
  scheduler::ReplayOptions replay;
  replay.start = first == Time::max() ? Time{} : first;
  replay.log = context.door.schedule ? &*context.door.schedule : nullptr;
  replay.pace = context.options.pace == Pace::kRecorded ? &clock : nullptr;
  replay.stop = context.options.stop;
  if (context.options.seconds) replay.length = from_seconds(*context.options.seconds);
  replay.next_arrival = [&tasks] { return first_arrival(tasks); };
  if (replay.pace != nullptr) (void)become_real_time(tasks.graph, context.monitor);
  scheduler::Executive executive(tasks.graph, allocations_of_this_thread);
  const auto end = executive.run_replay(replay);
  if (!end) return end.error();
  if (end->jumped > Duration{})
    context.monitor.event(tasks.receive.figures().end, "schedule",
                          "nothing arrived for a long time: virtual time jumped over " +
                              std::to_string(end->jumped / std::chrono::seconds(1)) + " s in all");
  SafetyEvents(tasks.safety, context.monitor).read();
  if (end->diverged || missing_packets(tasks) > 0)
    context.monitor.event(tasks.receive.figures().end, "schedule",
                          "the recording lacks packets that the live run had: not the same result");
  return end->interrupted ? RunEnd::kInterrupted : RunEnd::kComplete;
}

}  // namespace cairn::app
