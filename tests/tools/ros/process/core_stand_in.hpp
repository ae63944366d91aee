// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "drivers/clients/messages/clouds/scan.hpp"
#include "drivers/clients/messages/command.hpp"
#include "drivers/clients/messages/hello.hpp"
#include "drivers/clients/messages/picture.hpp"
#include "drivers/clients/messages/subscribe.hpp"
#include "drivers/clients/messages/tiles.hpp"
#include "drivers/clients/sockets/local_server.hpp"

namespace cairn::ros {

/// Both sockets of a core that says what a test wants. One client each.
class CoreStandIn {
 public:
  CoreStandIn(const std::filesystem::path& folder, clients::HelloMessage hello)
      : hello_(std::move(hello)),
        robot_(clients::LocalServer::open({.path = folder / "robot.sock"}).value()),
        command_(clients::LocalServer::open({.path = folder / "command.sock"}).value()) {}

  /// Greets who has come, and takes what was asked.
  void hear() {
    hear_robot();
    hear_command();
  }
  template <class Message>
  void say(const Message& message) {
    clients::begin_record(Message::kKind, sequence_++, bytes_);
    encode(message, bytes_);
    send();
  }
  void say_scan(clients::ScanPart part, std::span<const Eigen::Vector3f> points) {
    part.total = static_cast<std::uint32_t>(points.size());
    for (part.first = 0; part.first < part.total;) {
      clients::begin_record(clients::RecordKind::kScan, sequence_++, bytes_);
      part.first += encode(part, points, bytes_);
      send();
    }
  }
  void say_picture(const clients::PicturePart& part, std::span<const std::byte> bytes) {
    clients::begin_record(clients::RecordKind::kPicture, sequence_++, bytes_);
    encode(part, bytes, bytes_);
    send();
  }
  void say_tiles(const clients::TilesMessage& tiles) {
    clients::TilesWriter writer(tiles, sequence_++, bytes_);
    for (const auto& tile : tiles.tiles) writer.add(tile);
    writer.finish(true);
    (void)robot_.send(reader_, bytes_);
  }
  void answer(const clients::Answer& answer) {
    encode(answer, answers_++, bytes_);
    (void)command_.send(commander_, bytes_);
  }

  std::optional<clients::SubscribeMessage> subscription;
  std::vector<clients::Command> commands;  ///< all that came

 private:
  using Got = clients::LocalServer::Got;

  void hear_robot() {
    for (auto got = robot_.receive(bytes_, 1000); got.got != Got::kNothing; got = robot_.receive(bytes_, 1000)) {
      if (got.got == Got::kJoined) {
        reader_ = got.client;
        sequence_ = 0;
        say(hello_);
      }
      if (got.got == Got::kRecord)
        subscription = clients::decode_subscribe(clients::decode_record(bytes_).value().body).value();
    }
  }
  void hear_command() {
    for (auto got = command_.receive(bytes_, 1000); got.got != Got::kNothing; got = command_.receive(bytes_, 1000)) {
      if (got.got == Got::kRecord) commands.push_back(clients::decode_command(bytes_).value());
      if (got.got != Got::kJoined) continue;
      commander_ = got.client;
      answers_ = 0;
      answer({});
    }
  }
  void send() {
    clients::end_record(bytes_);
    (void)robot_.send(reader_, bytes_);
  }

  clients::HelloMessage hello_;
  clients::LocalServer robot_, command_;
  clients::LocalServer::ClientId reader_ = 0, commander_ = 0;
  std::uint32_t sequence_ = 0, answers_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace cairn::ros
