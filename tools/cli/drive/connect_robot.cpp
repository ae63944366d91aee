// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/drive/connect_robot.hpp"

namespace cairn::cli {

Result<clients::CommandClient> connect_robot(const std::filesystem::path& socket, std::string_view name,
                                             const Clock& clock) {
  auto robot = clients::CommandClient::connect(socket, name, clock);
  if (robot || robot.error().code == Errc::kNotFound || socket.filename() != "robot.sock") return robot;
  return Error{Errc::kInvalidConfig,
               "this socket takes no commands",
               socket.string(),
               {},
               "use " + (socket.parent_path() / "command.sock").string()};
}

}  // namespace cairn::cli
