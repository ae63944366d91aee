// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/commands/reasons.hpp"

namespace cairn::app {

void tell_faults(safety::FaultSet faults, Reason& why) {
  bool first = true;
  for (const safety::FaultRow& row : safety::fault_table()) {
    if (!faults.has(row.fault)) continue;
    why.append(first ? "" : ", ").append(row.code);
    first = false;
  }
}

void tell_state(const safety::FailsafeDecision& decision, const DriveStatus& drive, Reason& why) {
  if (!decision.active.empty()) {
    why.append(to_string(decision.mode)).append(": ");
    return tell_faults(decision.active, why);
  }
  if (drive.level != DriveLevel::kNormal) {
    why.append("drive: ").append(to_string(drive.cause));
    return;
  }
  if (decision.mode == safety::Mode::kStop) why.append("stopped: arm it");
}

}  // namespace cairn::app
