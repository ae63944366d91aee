// SPDX-License-Identifier: Apache-2.0
#include "hal/drive.hpp"

#include <array>

namespace cairn {

std::string_view to_string(DriveCause cause) {
  constexpr std::array<std::string_view, 16> kNames{"none",
                                                    "the motors are being enabled",
                                                    "no command",
                                                    "the command is not finite",
                                                    "late feedback",
                                                    "the send queue is full",
                                                    "not armed",
                                                    "stop requested",
                                                    "emergency stop",
                                                    "feedback lost",
                                                    "CAN error-passive",
                                                    "CAN bus-off",
                                                    "CAN link down",
                                                    "motor fault",
                                                    "motor controller started anew",
                                                    "the motors could not be enabled"};
  const auto i = static_cast<std::size_t>(cause);
  return i < kNames.size() ? kNames[i] : "unknown";
}

}  // namespace cairn
