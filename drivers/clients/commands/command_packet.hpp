// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/clients/messages/record.hpp"
#include "hal/files/packet_log.hpp"
#include "hal/packet.hpp"

// What comes by command.sock, as packets. Packet::channel is the number of the client's connection. A packet of one
// byte says that the client came or went. Every other one is the record of a command.
namespace cairn::clients {

/// More than a command has: 142 bytes of body with the longest names.
inline constexpr std::size_t kMaxCommandBytes = Record::kHeaderBytes + 160;
inline constexpr std::byte kClientLeft{0}, kClientJoined{1};

[[nodiscard]] inline bool is_joined(const Packet& packet) {
  return packet.bytes.size() == 1 && packet.bytes[0] == kClientJoined;
}
[[nodiscard]] inline bool is_left(const Packet& packet) {
  return packet.bytes.size() == 1 && packet.bytes[0] == kClientLeft;
}

/// commands.log of a recording. Its magic is "CCMD".
inline constexpr PacketLogFormat kCommandsLog{
    .magic = 0x444D4343, .most_bytes = kMaxCommandBytes, .contents = "what clients commanded"};

}  // namespace cairn::clients
