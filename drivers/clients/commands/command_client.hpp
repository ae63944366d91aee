// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "drivers/clients/messages/command.hpp"
#include "drivers/clients/sockets/local_client.hpp"
#include "hal/clock.hpp"

namespace cairn::clients {

/// A program that commands the robot through command.sock. While it is connected and goes on commanding, nobody else
/// may; stop() alone is open to all.
///
///     auto robot = CommandClient::connect("/run/cairn/command.sock", "my planner", clock);
///     robot->arm(std::chrono::seconds(5));
///     while (going) robot->drive(0.3, 0.0);  // ten times a second or more
class CommandClient {
 public:
  /// Waits for the core's greeting. `name` is what others are told; `clock` is this machine's, and must outlive the
  /// client. Errors: those of LocalClient::connect(); kLinkDown (no greeting came).
  static Result<CommandClient> connect(const std::filesystem::path& socket, std::string_view name, const Clock& clock);

  /// Sends a velocity: v in m/s forward, w in rad/s to the left, valid for Command::kMostValid. Does not wait; what
  /// became of it comes with next_answer(). False: the core is gone, or does not read.
  bool drive(double v, double w);
  /// Any command. Does not wait; the answer comes with next_answer(). Number, time and name are set here. False: as of
  /// drive().
  bool send(Command command);
  /// Ends the stop that the last answer told of, and waits until the motors are enabled. Errors: kLinkDown (the core is
  /// gone, or says nothing for `patience`). The answer may be a refusal.
  Result<Answer> arm(Duration patience);
  /// Stops the robot and disables its motors, until somebody arms it. Errors as of arm().
  Result<Answer> stop(Duration patience) { return ask({.verb = Command::Verb::kStop, .who = {}}, patience); }
  /// Any command, and its answer. Errors as of arm().
  Result<Answer> ask(Command command, Duration patience);

  /// Waits for the next answer. Errors: kLinkDown (the core is gone); kNotFound (nothing came in time); kMalformed,
  /// kUnsupported (what came is no answer).
  Result<Answer> next_answer(Duration timeout);
  /// The newest answer.
  [[nodiscard]] const Answer& last() const { return last_; }
  /// Readable when an answer has come: for poll().
  [[nodiscard]] int readable_fd() const { return socket_.readable_fd(); }

 private:
  CommandClient(LocalClient socket, std::filesystem::path path, std::string_view name, const Clock& clock)
      : socket_(std::move(socket)), path_(std::move(path)), name_(name), clock_(&clock) {}
  [[nodiscard]] Error gone() const;

  LocalClient socket_;
  std::filesystem::path path_;
  ClientName name_;
  const Clock* clock_;
  std::uint32_t number_ = 0;
  Answer last_;
  std::vector<std::byte> bytes_;
};

}  // namespace cairn::clients
