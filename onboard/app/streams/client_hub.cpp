// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/client_hub.hpp"

#include <algorithm>
#include <utility>

#include "hal/clock.hpp"

namespace cairn::app {
namespace {

using clients::LocalServer;

constexpr const char* kSocketName = "robot.sock";
// Of one client in the kernel. The record that says what a client wants is far shorter.
constexpr int kWaitingBytes = 128 * 1024;
constexpr std::size_t kMostReceived = 1024;

}  // namespace

Result<ClientHub> ClientHub::open(const std::filesystem::path& folder, const clients::HelloMessage& hello,
                                  Monitor& monitor) {
  auto server = LocalServer::open(
      {.path = folder / kSocketName, .most_clients = kMostClients, .waiting_bytes = kWaitingBytes, .group = "cairn"});
  if (!server) return server.error();
  return ClientHub(std::move(*server), hello, monitor);
}

void ClientHub::receive(Time now) {
  int joins = 0;
  for (std::size_t i = 0; i < kMostInATick * (clients_.size() + 1); ++i) {
    const LocalServer::Received received = server_.receive(received_, kMostReceived);
    if (received.got == LocalServer::Got::kNothing) break;
    if (received.got == LocalServer::Got::kJoined) {
      greet(received.client);
      if (++joins == kMostJoins) break;  // all others have had their turns
    }
    if (received.got == LocalServer::Got::kRecord) take(received.client, now);
    if (received.got == LocalServer::Got::kLeft)
      std::erase_if(clients_, [&](const StreamClient& client) { return client.id == received.client; });
  }
  const std::uint64_t before = std::exchange(turned_away_, server_.turned_away());
  if (before != turned_away_)
    monitor_->event(now, "clients", "robot.sock has 32 clients: a further one was turned away");
}

void ClientHub::greet(LocalServer::ClientId id) {
  StreamClient& client = clients_.emplace_back();
  client.id = id;
  hello_.realtime_offset = LiveClock::realtime_offset();
  send(client, hello_);
}

void ClientHub::take(LocalServer::ClientId id, Time now) {
  const auto client = std::ranges::find(clients_, id, &StreamClient::id);
  if (client == clients_.end()) return;
  const auto record = clients::decode_record(received_);
  const bool subscribes = record && record->kind == clients::RecordKind::kSubscribe;
  const auto wants = subscribes ? clients::decode_subscribe(record->body) : Error{Errc::kMalformed, "no subscription"};
  if (!wants) {
    monitor_->event(now, "clients", "a client of robot.sock sent what is no subscription: it was dropped");
    server_.drop(id);
    clients_.erase(client);
    return;
  }
  client->wants = *wants;
  client->fresh = true;
  client->predictions = RateLimit(wants->pose_hz);
  client->scans = client->thermals = RateLimit(wants->scan_hz);
  for (PictureCursor& picture : client->pictures) picture.limit = RateLimit(static_cast<double>(wants->picture_hz));
}

bool ClientHub::anybody_wants(clients::Stream stream) const {
  return std::ranges::any_of(clients_, [&](const StreamClient& client) { return client.wants.wants(stream); });
}

bool ClientHub::send(StreamClient& client, clients::RecordKind kind, std::span<const std::byte> body) {
  clients::begin_record(kind, client.sequence++, record_);
  record_.insert(record_.end(), body.begin(), body.end());
  clients::end_record(record_);
  return server_.send(client.id, record_);
}

bool ClientHub::try_send(StreamClient& client, std::span<const std::byte> record) {
  if (!server_.send_bulk(client.id, record)) return false;
  ++client.sequence;
  return true;
}

}  // namespace cairn::app
