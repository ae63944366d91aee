// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/team/team.hpp"
#include "hal/monitor.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Compares maps, one pair at a time, at the lowest priority.
class MatchTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<team::MatchJob> jobs{*this, "jobs"};
  const std::size_t steps_slot = take_slots();  ///< steps granted
  scheduler::OutputPort<team::MatchJob> results{*this, "results"};

  /// `limit`: how long one comparison may take. `monitor` must outlive the task.
  MatchTask(Duration limit, Monitor& monitor) : limit_(limit), stage_(monitor.stage("matching")) {}
  void tick(scheduler::Tick& tick) override;

 private:
  Duration limit_;
  StageStats& stage_;
};

}  // namespace cairn::app
