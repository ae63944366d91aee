// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/commands/command_client.hpp"

#include <algorithm>

#include "drivers/clients/messages/record.hpp"

namespace cairn::clients {
namespace {

// The drive task greets with its next tick, a hundredth of a second later.
constexpr Duration kGreeting = std::chrono::seconds(5);

}  // namespace

Error CommandClient::gone() const {
  return {Errc::kLinkDown, "the core has gone, or has turned this client away", path_.string(), {}, {}};
}

Result<CommandClient> CommandClient::connect(const std::filesystem::path& socket, std::string_view name,
                                             const Clock& clock) {
  auto connected = LocalClient::connect(socket);
  if (!connected) return connected.error();
  CommandClient client(std::move(*connected), socket, name, clock);
  const auto greeting = client.next_answer(kGreeting);
  if (!greeting && greeting.error().code == Errc::kNotFound) return client.gone();
  if (!greeting) return greeting.error();
  return client;
}

bool CommandClient::send(Command command) {
  command.number = ++number_;
  command.sent = clock_->now();
  command.who = name_;
  encode(command, bytes_);
  return socket_.send(bytes_);
}

bool CommandClient::drive(double v, double w) {
  return send({.verb = Command::Verb::kVelocity, .valid_for = Command::kMostValid, .v = v, .w = w, .who = {}});
}

Result<Answer> CommandClient::arm(Duration patience) {
  return ask({.verb = Command::Verb::kArm, .epoch = last_.epoch, .who = {}}, patience);
}

Result<Answer> CommandClient::ask(Command command, Duration patience) {
  if (!send(command)) return gone();
  for (const Time until = clock_->now() + patience; clock_->now() < until;) {
    const auto answer = next_answer(until - clock_->now());
    if (answer && answer->number == number_) return answer;
    if (!answer && answer.error().code != Errc::kNotFound) return answer.error();
  }
  return Error{Errc::kLinkDown, "the core does not answer", path_.string(), {}, {}};
}

Result<Answer> CommandClient::next_answer(Duration timeout) {
  switch (socket_.receive(bytes_, Record::kHeaderBytes + Record::kMaxBody, timeout)) {
    case LocalClient::Got::kEnd:
      return gone();
    case LocalClient::Got::kNothing:
      return Error{Errc::kNotFound, "no answer came in time", path_.string(), {}, {}};
    case LocalClient::Got::kMessage:
      break;
  }
  auto answer = decode_answer(bytes_);
  if (answer) last_ = *answer;
  return answer;
}

}  // namespace cairn::clients
