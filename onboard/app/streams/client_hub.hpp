// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/clients/messages/hello.hpp"
#include "drivers/clients/messages/subscribe.hpp"
#include "drivers/clients/messages/tiles.hpp"
#include "drivers/clients/sockets/local_server.hpp"
#include "hal/monitor.hpp"
#include "onboard/app/streams/outlets/picture_outlet.hpp"
#include "onboard/app/streams/rate_limit.hpp"

namespace cairn::app {

/// How far a client has come with the tiles of one map.
struct TileCursor {
  std::uint32_t epoch = 0;
  std::uint64_t version = 0;  ///< it has all up to here
  bool caught_up = false;     ///< and was told so
  Time retry{};               ///< its socket was full; not before
  Duration pause{};           ///< that was waited last
};

/// How far a client has come with the pictures of one camera.
struct PictureCursor {
  RateLimit limit;
  std::optional<std::uint32_t> bytes;  ///< of the present picture, that it has; none: it gets no more of it
};

/// One client of robot.sock.
struct StreamClient {
  clients::LocalServer::ClientId id = 0;
  clients::SubscribeMessage wants;
  bool fresh = false;          ///< its subscription has just come
  std::uint32_t sequence = 0;  ///< of its next record
  RateLimit predictions, scans, thermals;
  std::array<TileCursor, 2> tiles;                    ///< by clients::TileMap
  std::optional<std::uint32_t> scan_points;           ///< of the present scan, that it has; none: it gets no more of it
  std::optional<std::uint32_t> thermal_points;        ///< the same of the present thermal cloud
  std::array<PictureCursor, kShownCameras> pictures;  ///< by camera
};

/// The clients of robot.sock and what they want. No call waits. A client that sends anything but a subscription is
/// dropped.
class ClientHub {
 public:
  static constexpr std::size_t kMostClients = 32;
  static constexpr std::size_t kMostInATick = 4;  ///< records that a client may send, on average of all
  static constexpr int kMostJoins = 2;            ///< clients that may join in a tick

  /// Serves `folder`/robot.sock. Every new client is greeted with `hello`. `monitor` must outlive the hub. Errors: see
  /// clients::LocalServer::open().
  [[nodiscard]] static Result<ClientHub> open(const std::filesystem::path& folder, const clients::HelloMessage& hello,
                                              Monitor& monitor);

  /// Takes in who has come and gone, and what was asked for.
  void receive(Time now);
  [[nodiscard]] std::vector<StreamClient>& clients() { return clients_; }
  [[nodiscard]] bool anybody_wants(clients::Stream stream) const;

  /// A record with this body; a client that has no room for it loses it, and sees a gap in the sequence. False then.
  bool send(StreamClient& client, clients::RecordKind kind, std::span<const std::byte> body);
  /// The same for a message.
  template <class Message>
  bool send(StreamClient& client, const Message& message) {
    return send(client, Message::kKind, body_of(message));
  }
  /// The same for all clients that want the stream.
  template <class Message>
  void send_all(clients::Stream stream, const Message& message) {
    const auto body = body_of(message);
    for (StreamClient& client : clients_)
      if (client.wants.wants(stream)) send(client, Message::kKind, body);
  }
  template <class Message>
  [[nodiscard]] std::span<const std::byte> body_of(const Message& message) {
    body_.clear();
    encode(message, body_);
    return body_;
  }
  /// A whole record that has the client's next sequence. False: there is no room; nothing is lost, it may come again.
  /// It leaves room for those that send() sends.
  bool try_send(StreamClient& client, std::span<const std::byte> record);

 private:
  ClientHub(clients::LocalServer server, const clients::HelloMessage& hello, Monitor& monitor)
      : server_(std::move(server)), hello_(hello), monitor_(&monitor) {}
  void greet(clients::LocalServer::ClientId id);
  void take(clients::LocalServer::ClientId id, Time now);

  clients::LocalServer server_;
  clients::HelloMessage hello_;
  Monitor* monitor_;
  std::vector<StreamClient> clients_;
  std::vector<std::byte> received_, body_, record_;  // reused
  std::uint64_t turned_away_ = 0;
};

}  // namespace cairn::app
