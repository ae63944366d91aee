// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "drivers/clients/commands/command_client.hpp"

namespace cairn::cli {

/// Connects to command.sock of a core as the client of this name. The error says if it is the other socket.
[[nodiscard]] Result<clients::CommandClient> connect_robot(const std::filesystem::path& socket, std::string_view name,
                                                           const Clock& clock);

}  // namespace cairn::cli
