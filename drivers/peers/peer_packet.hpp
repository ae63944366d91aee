// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/bytes.hpp"
#include "hal/files/packet_log.hpp"
#include "hal/packet.hpp"

// What comes from the team, as packets. The first packet tells who this robot is in the team: a replay needs it.
namespace cairn::peer_link {

enum class PacketKind : std::uint16_t {  ///< Packet::channel
  kDatagram = 0,                         ///< what a peer sent
  kBeginning = 1,                        ///< who this robot is; made by the robot itself
};
inline constexpr std::size_t kMaxPacket = 1200;
/// peers.log of a recording. Its magic is "CPRL".
inline constexpr PacketLogFormat kPeersLog{
    .magic = 0x4C525043, .most_bytes = kMaxPacket, .contents = "what peers sent"};

/// The id and the epoch that this robot takes part with.
struct Beginning {
  std::uint64_t robot = 0, epoch = 0;
  friend bool operator==(const Beginning&, const Beginning&) = default;
};

inline void encode(const Beginning& beginning, Packet& packet) {
  packet.channel = static_cast<std::uint16_t>(PacketKind::kBeginning);
  packet.bytes.clear();
  append_le(packet.bytes, beginning.robot);
  append_le(packet.bytes, beginning.epoch);
}
/// Nothing if the bytes are not a Beginning. No robot has the id 0.
[[nodiscard]] inline std::optional<Beginning> decode_beginning(std::span<const std::byte> bytes) {
  if (bytes.size() != 16 || load_le<std::uint64_t>(bytes, 0) == 0) return std::nullopt;
  return Beginning{load_le<std::uint64_t>(bytes, 0), load_le<std::uint64_t>(bytes, 8)};
}

}  // namespace cairn::peer_link
