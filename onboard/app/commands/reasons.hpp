// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/clients/messages/command.hpp"
#include "hal/drive.hpp"
#include "onboard/safety/failsafe.hpp"

namespace cairn::app {

/// Where an answer says why.
using Reason = clients::ShortText<200>;

/// Appends the codes of the faults, such as "e_stop_open, link_down". Allocates nothing.
void tell_faults(safety::FaultSet faults, Reason& why);
/// Appends why the robot does not move, or not as fast as it could. Nothing where all is well. Allocates nothing.
void tell_state(const safety::FailsafeDecision& decision, const DriveStatus& drive, Reason& why);

}  // namespace cairn::app
