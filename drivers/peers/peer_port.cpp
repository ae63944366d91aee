// SPDX-License-Identifier: Apache-2.0
#include "drivers/peers/peer_port.hpp"

namespace cairn::peer_link {

Result<std::unique_ptr<PeerPort>> PeerPort::open(const std::filesystem::path& socket, const Beginning& beginning,
                                                 SourceId source, const Clock& clock) {
  auto link = LocalLink::listen(socket);
  if (!link) return link.error();
  return std::unique_ptr<PeerPort>(new PeerPort(std::move(*link), beginning, source, clock));
}

Result<Poll> PeerPort::next(Packet& packet, Duration /*timeout*/) {
  packet.truncated = false;
  packet.source = source_;
  if (delivered_ == 0) {
    encode(beginning_, packet);
  } else {
    LinkFrame frame;
    do {
      if (!link_.join() || !link_.receive(memory_, frame)) return Poll::kTimeout;
    } while (frame.kind != LinkFrame::Kind::kReceived);
    packet.channel = static_cast<std::uint16_t>(PacketKind::kDatagram);
    packet.bytes.assign(frame.bytes.begin(), frame.bytes.end());
  }
  packet.sequence = delivered_++;
  packet.arrival = clock_.now();
  return Poll::kPacket;
}

bool PeerPort::send(std::uint64_t robot, std::span<const std::byte> datagram) {
  return link_.join() && link_.send({LinkFrame::Kind::kSend, robot, datagram});
}

}  // namespace cairn::peer_link
