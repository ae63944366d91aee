// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/commands/serve_commands.hpp"

#include "drivers/clients/commands/command_socket.hpp"
#include "onboard/app/door/fitted.hpp"

namespace cairn::app {

Result<void> serve_commands(const std::filesystem::path& sockets, const RobotProfile& profile, const Clock& clock,
                            Door& door) {
  if (!fitted_with(door.recording.sources, profile).drive && profile.team.id == 0) return {};
  recording::SourceEntry entry;
  entry.id = to_string(recording::kCommands);
  entry.kind = recording::kCommands;
  entry.file = "commands.log";
  auto socket = clients::CommandSocket::open(command_socket(sockets), static_cast<SourceId>(door.inputs.size()), clock);
  if (!socket) return at(entry.id, socket.error());
  Input input;
  input.entry = entry;
  input.answers = socket->get();
  input.losses = [reader = socket->get()] {
    const auto& c = reader->counters();
    return Losses{{"refused", c.refused}, {"unanswered", c.unanswered}};
  };
  input.source = std::move(*socket);
  door.inputs.push_back(std::move(input));
  door.recording.sources.push_back(entry);
  return {};
}

}  // namespace cairn::app
