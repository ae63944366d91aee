// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drivers/clients/commands/command_client.hpp"
#include "hal/clock.hpp"
#include "tools/ros/messages/diagnostics.hpp"
#include "tools/ros/messages/velocity.hpp"

namespace cairn::ros {

/// Commands from the network to the core, as one client of command.sock. It connects with the first command, and again
/// after the core has gone. Whether the robot moves is the core's decision.
class CommandRelay {
 public:
  /// `clock` is this machine's and must outlive the relay.
  CommandRelay(std::filesystem::path socket, const Clock& clock) : socket_(std::move(socket)), clock_(&clock) {}

  /// A velocity that came at most `held_up` ago: it is valid for clients::Command::kMostValid from then on.
  void drive(const Velocity& velocity, Duration held_up);
  /// Ends the stop with this epoch.
  void arm(std::uint32_t epoch);
  void disarm() { send({.verb = clients::Command::Verb::kDisarm, .who = {}}); }
  void stop() { send({.verb = clients::Command::Verb::kStop, .who = {}}); }
  /// Where the robot is, by somebody who knows.
  void place(const clients::Placement& place) {
    send({.verb = clients::Command::Verb::kPlace, .who = {}, .place = place});
  }
  /// What came and was not passed on.
  void refuse(std::string_view what, std::string_view why);

  /// Takes the core's answers; to be called when there may be some, and now and then.
  void read_answers();
  /// -1: not connected.
  [[nodiscard]] int readable_fd() const { return client_ ? client_->readable_fd() : -1; }

  /// What became of the commands, for people.
  [[nodiscard]] Diagnosis diagnosis() const;

 private:
  void send(clients::Command command);
  bool connected();

  std::filesystem::path socket_;
  const Clock* clock_;
  std::optional<clients::CommandClient> client_;
  std::optional<Time> failed_;  // to connect, last
  std::optional<clients::Answer> answer_;
  std::string trouble_, refusal_;
  std::uint64_t sent_ = 0, refused_ = 0;
};

}  // namespace cairn::ros
