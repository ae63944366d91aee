// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "drivers/clients/messages/command.hpp"

namespace CLI {
class App;
}

namespace cairn::cli {

/// What an answer says, in one line for people: "limited to 0.20 m/s, 0.00 rad/s: degraded: odometry_lost".
[[nodiscard]] std::string text_of(const clients::Answer& answer);
/// The same for programs: outcome, stopped, epoch, v, omega, holder, why.
[[nodiscard]] nlohmann::ordered_json json_of(const clients::Answer& answer);

/// --socket, with the place of the service's command socket.
void add_socket_option(CLI::App& app, std::filesystem::path& socket);

}  // namespace cairn::cli
