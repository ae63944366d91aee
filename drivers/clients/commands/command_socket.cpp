// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/commands/command_socket.hpp"

#include "drivers/clients/commands/command_packet.hpp"

namespace cairn::clients {

Result<std::unique_ptr<CommandSocket>> CommandSocket::open(const std::filesystem::path& path, SourceId id,
                                                           const Clock& clock) {
  constexpr int kWaitingBytes = 16 * 1024;  // some fifty answers
  auto server =
      LocalServer::open({.path = path, .most_clients = kMostClients, .waiting_bytes = kWaitingBytes, .group = kGroup});
  if (!server) return server.error();
  return std::unique_ptr<CommandSocket>(new CommandSocket(std::move(*server), id, clock));
}

CommandSocket::CommandSocket(LocalServer server, SourceId id, const Clock& clock)
    : server_(std::move(server)), id_(id), clock_(clock) {
  constexpr std::size_t kLongestAnswer = 512;
  out_.reserve(kLongestAnswer);
}

Result<Poll> CommandSocket::next(Packet& packet, Duration /*timeout*/) {
  while (in_a_row_ < kMostInARow) {
    ++in_a_row_;
    const LocalServer::Received received = server_.receive(packet.bytes, kMaxCommandBytes);
    if (received.got == LocalServer::Got::kNothing) break;
    if (!fill(received, packet)) continue;
    packet.source = id_;
    packet.channel = received.client;
    packet.sequence = delivered_++;
    packet.arrival = clock_.now();
    packet.truncated = false;
    return Poll::kPacket;
  }
  in_a_row_ = 0;
  return Poll::kTimeout;
}

/// False: it is no packet.
bool CommandSocket::fill(const LocalServer::Received& received, Packet& packet) {
  if (received.got != LocalServer::Got::kRecord) {
    const bool joined = received.got == LocalServer::Got::kJoined;
    packet.bytes.assign(1, joined ? kClientJoined : kClientLeft);
    if (joined) ++counters_.joined;
    return true;
  }
  if (decode_command(packet.bytes)) {
    ++counters_.commands;
    return true;
  }
  ++counters_.refused;
  server_.drop(received.client);
  return false;
}

bool CommandSocket::answer(std::uint16_t client, const Answer& answer) {
  encode(answer, ++answers_, out_);
  if (server_.send(client, out_)) return true;
  ++counters_.unanswered;
  return false;
}

}  // namespace cairn::clients
