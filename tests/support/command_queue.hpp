// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <vector>

#include "drivers/clients/commands/answer_port.hpp"
#include "drivers/clients/commands/command_packet.hpp"
#include "drivers/clients/messages/command.hpp"
#include "hal/ports.hpp"

namespace cairn::support {

/// A command socket without the socket: clients say things at times, and their answers are kept.
class CommandQueue final : public Source, public clients::AnswerPort {
 public:
  void join(std::uint16_t client, Time now) { push(client, now, {clients::kClientJoined}); }
  void leave(std::uint16_t client, Time now) { push(client, now, {clients::kClientLeft}); }
  /// With the client's next number, sent now; a velocity is valid for 200 ms unless it says otherwise.
  void say(std::uint16_t client, Time now, clients::Command command) {
    command.number = ++numbers_[client];
    command.sent = now;
    if (command.valid_for == Duration{}) command.valid_for = clients::Command::kMostValid;
    std::vector<std::byte> bytes;
    encode(command, bytes);
    push(client, now, std::move(bytes));
  }
  void arm(Time now, std::uint32_t epoch) {
    say(1, now, {.verb = clients::Command::Verb::kArm, .epoch = epoch, .who = {}});
  }
  void drive(Time now, double v, double w = 0) {
    say(1, now, {.verb = clients::Command::Verb::kVelocity, .v = v, .w = w, .who = {}});
  }

  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    if (waiting_.empty()) return Poll::kTimeout;
    packet = waiting_.front();
    waiting_.pop_front();
    return Poll::kPacket;
  }
  bool answer(std::uint16_t client, const clients::Answer& answer) override {
    if (keep_answers) answers.push_back({client, answer});
    return true;
  }

  struct Answered {
    std::uint16_t client;
    clients::Answer answer;
  };
  std::vector<Answered> answers;
  bool keep_answers = true;

 private:
  void push(std::uint16_t client, Time now, std::vector<std::byte> bytes) {
    Packet& packet = waiting_.emplace_back();
    packet.channel = client;
    packet.sequence = sequence_++;
    packet.arrival = now;
    packet.bytes = std::move(bytes);
  }
  std::deque<Packet> waiting_;
  std::map<std::uint16_t, std::uint32_t> numbers_;
  std::uint64_t sequence_ = 0;
};

}  // namespace cairn::support
