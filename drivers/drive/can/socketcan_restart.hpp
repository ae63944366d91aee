// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hal/result.hpp"

namespace cairn::drive {

/// Restarts the CAN controller of interface `index` after bus-off (rtnetlink, IFLA_CAN_RESTART), as
/// `ip link set can0 type can restart` does. Error kIo with the reason of the system and the remedy.
[[nodiscard]] Result<void> restart_can(const std::string& interface, int index);

}  // namespace cairn::drive
