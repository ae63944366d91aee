// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/bus_name.hpp"

#include <algorithm>
#include <cstddef>

namespace cairn::drive {

Result<std::string> path_of_unix_bus(std::string_view interface) {
  constexpr std::size_t kMostPath = 107;  // bytes; sockaddr_un::sun_path has one more, for its end
  const std::string_view path = interface.substr(std::min(interface.size(), kUnixBus.size()));
  if (is_unix_bus(interface) && !path.empty() && path.size() <= kMostPath) return std::string(path);
  return Error{Errc::kInvalidConfig,
               "no name of a CAN bus on a Unix socket",
               std::string(interface),
               {},
               "unix:PATH is expected, with a path of at most 107 bytes"};
}

bool is_bus_name(std::string_view interface) {
  constexpr std::size_t kMostName = 15;  // bytes, of a network interface
  if (is_unix_bus(interface)) return path_of_unix_bus(interface).has_value();
  return !interface.empty() && interface.size() <= kMostName && interface.find('/') == std::string_view::npos;
}

}  // namespace cairn::drive
