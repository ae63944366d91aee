// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/monitor.hpp"
#include "onboard/app/tasks/safety_task.hpp"

namespace cairn::app {

/// Makes events of the changes that the safety task leaves: the safety task itself may neither lock nor allocate.
class SafetyEvents {
 public:
  /// Both must outlive it.
  SafetyEvents(SafetyTask& safety, Monitor& monitor) : safety_(safety), monitor_(monitor) {}

  /// Takes every change that is there.
  void read();
  /// Mode, cause, active faults and epoch after the last change that was read.
  [[nodiscard]] const safety::FailsafeDecision& decision() const { return decision_; }

 private:
  SafetyTask& safety_;
  Monitor& monitor_;
  safety::FailsafeDecision decision_;
};

}  // namespace cairn::app
