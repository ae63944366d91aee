// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <string>

namespace cairn::support {

/// A loopback address that no other program of this machine uses: tests that run side by side may then use the same
/// ports, and none hears what was sent to another.
inline std::string own_address() {
  const auto id = static_cast<unsigned>(::getpid());  // 22 bits at most
  return "127." + std::to_string(id >> 16U) + "." + std::to_string(id >> 8U & 0xFFU) + "." + std::to_string(id & 0xFFU);
}

}  // namespace cairn::support
