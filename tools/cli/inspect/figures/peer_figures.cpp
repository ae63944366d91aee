// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/figures/peer_figures.hpp"

#include <nlohmann/json.hpp>
#include <variant>

#include "drivers/peers/peer_packet.hpp"
#include "fusion/peers/datagrams/datagram.hpp"

namespace cairn::cli {

Result<const Scan*> PeerFigures::take(const Packet& packet) {
  if (packet.channel == static_cast<std::uint16_t>(peer_link::PacketKind::kBeginning)) {
    const auto beginning = peer_link::decode_beginning(packet.payload());
    if (!beginning) return Error{Errc::kMalformed, "not a beginning"};
    self_ = beginning->robot;
    epoch_ = beginning->epoch;
    return nullptr;
  }
  const auto datagram = peers::decode_datagram(packet.payload());
  rejected_ += datagram ? 0 : 1;
  if (!datagram) return datagram.error();
  if (peers_.size() == kMaxPeers && !peers_.contains(datagram->sender)) return ++others_, nullptr;
  PerPeer& peer = peers_[datagram->sender];
  peer.bytes += packet.bytes.size();
  if (datagram->hello) peer.name = datagram->hello->name;
  peer.hellos += datagram->hello ? 1 : 0;
  peer.digests += datagram->digest.layers.empty() ? 0 : 1;
  peer.items += datagram->items ? datagram->items->updates.size() : 0;
  return nullptr;
}

report::Json PeerFigures::to_json() const {
  report::Json peers = report::Json::object();
  for (const auto& [robot, peer] : peers_)
    peers[std::to_string(robot)] = {{"name", peer.name},
                                    {"hellos", peer.hellos},
                                    {"digests", peer.digests},
                                    {"items", peer.items},
                                    {"bytes", peer.bytes}};
  return {{"robot", self_}, {"epoch", epoch_}, {"rejected", rejected_}, {"of_others", others_}, {"peers", peers}};
}

}  // namespace cairn::cli
