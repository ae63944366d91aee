// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/figures/command_figures.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/clients/commands/command_packet.hpp"
#include "drivers/clients/messages/command.hpp"

namespace cairn::cli {

Result<const Scan*> CommandFigures::take(const Packet& packet) {
  if (clients::is_left(packet)) return nullptr;
  if (clients::is_joined(packet)) return ++connections_, nullptr;
  const auto command = clients::decode_command(packet.payload());
  if (!command) return command.error();
  ++verbs_[std::string(to_string(command->verb))];
  if (names_.size() < kMaxNames) names_.emplace(command->who.view());
  if (command->verb != clients::Command::Verb::kVelocity) return nullptr;
  fastest_m_s_ = std::max(fastest_m_s_, std::abs(command->v));
  fastest_rad_s_ = std::max(fastest_rad_s_, std::abs(command->w));
  return nullptr;
}

report::Json CommandFigures::to_json() const {
  return {{"connections", connections_},
          {"commands", verbs_},
          {"clients", names_},
          {"fastest_m_s", fastest_m_s_},
          {"fastest_rad_s", fastest_rad_s_}};
}

}  // namespace cairn::cli
