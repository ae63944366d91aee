// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <filesystem>
#include <optional>
#include <string_view>

#include "hal/result.hpp"

// What both ends of a local socket need.
namespace cairn::clients {

inline constexpr int kLocalType = SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK;
inline constexpr const char* kPathRule = "107 bytes at most";

/// Nothing for a path that is empty or too long.
[[nodiscard]] std::optional<sockaddr_un> local_address(const std::filesystem::path& path);
/// A connection, or −1 with errno.
[[nodiscard]] int connect_local(const sockaddr_un& address);
/// The error that errno tells of.
[[nodiscard]] Error local_error(std::string_view cause, const std::filesystem::path& path);

}  // namespace cairn::clients
