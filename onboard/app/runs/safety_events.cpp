// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/safety_events.hpp"

#include <string>

namespace cairn::app {

void SafetyEvents::read() {
  for (; const SafetyTask::Change* change = safety_.changes().front(); safety_.changes().pop()) {
    for (const safety::FaultRow& row : safety::fault_table()) {
      if (change->raised.has(row.fault)) monitor_.event(change->at, "safety", "fault: " + std::string(row.code));
      if (change->ended.has(row.fault)) monitor_.event(change->at, "safety", "ended: " + std::string(row.code));
    }
    monitor_.event(change->at, "safety", "mode: " + std::string(to_string(change->mode)));
    decision_.mode = change->mode;
    decision_.cause = change->cause;
    decision_.active = change->active;
    decision_.epoch = change->epoch;
  }
}

}  // namespace cairn::app
