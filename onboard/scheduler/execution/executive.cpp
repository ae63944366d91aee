// SPDX-License-Identifier: Apache-2.0
#include "onboard/scheduler/execution/executive.hpp"

#include "onboard/scheduler/execution/run_end.hpp"
#include "onboard/scheduler/execution/serial_replay.hpp"
#include "onboard/scheduler/execution/threaded_replay.hpp"

namespace cairn::scheduler {

void Executive::run_live(const LiveOptions& options, const Clock& clock) {
  scheduler::run_live(graph_, options, clock, allocations_);
  drain(graph_, &clock);
}

Result<ReplayEnd> Executive::run_replay(const ReplayOptions& options) {
  const auto schedule = ReplaySchedule::prepare(graph_, options);
  if (!schedule) return schedule.error();
  Silence silence(graph_, options.next_arrival);
  ReplayEnd end = options.pace != nullptr ? replay_on_threads(*schedule, options.start, *options.pace, allocations_)
                                          : replay_serially(*schedule, &silence);
  end.jumped = silence.jumped();
  drain(graph_, nullptr);
  return end;
}

}  // namespace cairn::scheduler
