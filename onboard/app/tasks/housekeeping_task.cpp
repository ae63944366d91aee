// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/housekeeping_task.hpp"

namespace cairn::app {

void HousekeepingTask::tick(scheduler::Tick& tick) {
  write_log();
  if (recorder_ != nullptr) recorder_->write_waiting(tick.release());
  for (const Chore& chore : chores_) chore(tick.release());
}

void HousekeepingTask::write_log() {
  std::size_t number = 0;
  for (scheduler::ScheduledTask& task : graph_.tasks()) {
    if (task.live_only()) continue;
    if (!begun_) log_.task(number, task.spec.name, task.releases);
    ++number;
  }
  begun_ = true;
  number = 0;
  for (scheduler::ScheduledTask& task : graph_.tasks()) {
    if (task.live_only()) continue;
    for (; task.log.front() != nullptr; task.log.pop()) log_.tick(number, *task.log.front());
    ++number;
  }
  log_.flush();
  if (log_.failed()) ++failures_;
}

Result<void> HousekeepingTask::close(Time now) {
  write_log();
  std::size_t number = 0;
  for (const scheduler::ScheduledTask& task : graph_.tasks()) {
    if (task.live_only()) continue;
    log_.end(number++, task.next);
  }
  if (recorder_ != nullptr) recorder_->close(now);
  return log_.close();
}

}  // namespace cairn::app
