// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace cairn::drive {

/// How the name of a bus begins that another program of this machine plays: unix:PATH.
inline constexpr std::string_view kUnixBus = "unix:";
[[nodiscard]] inline bool is_unix_bus(std::string_view interface) { return interface.starts_with(kUnixBus); }
/// The path in such a name. Error kInvalidConfig: it is empty or too long for the address of a Unix socket.
[[nodiscard]] Result<std::string> path_of_unix_bus(std::string_view interface);

/// Whether a CAN bus can have this name: that of a network interface, or unix:PATH.
[[nodiscard]] bool is_bus_name(std::string_view interface);

}  // namespace cairn::drive
