// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/commands/commander.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/clients/commands/command_packet.hpp"
#include "onboard/app/commands/reasons.hpp"

namespace cairn::app {
namespace {

using clients::Answer;
using clients::Command;
using Verb = Command::Verb;

// Two for each packet that the socket gives in one tick.
constexpr std::size_t kMostReplies = std::size_t{2} * clients::CommandSocket::kMostInARow;

bool can_move(const Commander::Situation& now) {
  return now.decision.mode != safety::Mode::kStop && now.drive.level != DriveLevel::kStop;
}

}  // namespace

Commander::Commander(const Abilities& abilities) : abilities_(abilities) { replies_.reserve(kMostReplies); }

Answer* Commander::reply(std::uint16_t client, const Command& command, Outcome outcome, const Situation& now) {
  if (replies_.size() == kMostReplies) return nullptr;
  Answer& answer = replies_.emplace_back(Reply{client, {}}).answer;
  answer.outcome = outcome;
  answer.number = command.number;
  answer.epoch = now.decision.epoch;
  answer.stopped = !can_move(now);
  answer.holder = holder_.name;
  return &answer;
}

void Commander::refuse(std::uint16_t client, const Command& command, Outcome outcome, std::string_view why,
                       const Situation& now) {
  if (Answer* answer = reply(client, command, outcome, now)) answer->why.append(why);
}

void Commander::take(const Packet& packet, const Situation& now) {
  if (holder_.client != 0 && now.now - holder_.heard > kLease) give_lease_back();
  if (clients::is_joined(packet)) return join(packet.channel, now);
  if (clients::is_left(packet)) return leave(packet.channel);
  const auto command = clients::decode_command(packet.payload());
  if (!command) return;
  if (!in_order(packet.channel, command->number))
    return refuse(packet.channel, *command, Outcome::kStale, "a later command came before it", now);
  obey(packet.channel, *command, now);
}

void Commander::join(std::uint16_t client, const Situation& now) {
  if (auto* const place = std::ranges::find(known_, 0, &Known::client); place != known_.end()) *place = {client, 0};
  if (Answer* greeting = reply(client, {}, Outcome::kDone, now)) tell_state(now.decision, now.drive, greeting->why);
}

void Commander::leave(std::uint16_t client) {
  if (auto* const place = std::ranges::find(known_, client, &Known::client); place != known_.end()) *place = {};
  if (holder_.client == client) give_lease_back();
  if (arming_.client == client) arming_ = {};
  if (moving_.client == client) moving_ = {};
}

bool Commander::in_order(std::uint16_t client, std::uint32_t number) {
  auto* const place = std::ranges::find(known_, client, &Known::client);
  if (place == known_.end()) return number > 0;
  if (number <= place->last_number) return false;
  place->last_number = number;
  return true;
}

/// True: this client commands, from now on at least.
bool Commander::lease(std::uint16_t client, const Command& command, Time now) {
  if (holder_.client != 0 && holder_.client != client) return false;
  holder_ = {client, command.who, now};
  if (holder_.name.empty()) holder_.name.append("a client without a name");
  return true;
}

void Commander::give_lease_back() {
  holder_ = {};
  valid_until_ = Time::min();
}

void Commander::obey(std::uint16_t client, const Command& command, const Situation& now) {
  if (command.verb == Verb::kPlace) return take_place(client, command, now);
  if (!abilities_.drives) return refuse(client, command, Outcome::kRefused, "this robot has no drive", now);
  if (command.verb == Verb::kStop) return stop(client, command, now);
  if (!lease(client, command, now.now))
    return refuse(client, command, Outcome::kNotHolder, "another client commands; only stop is open to all", now);
  switch (command.verb) {
    case Verb::kVelocity:
      return take_velocity(client, command, now);
    case Verb::kArm:
      return take_arm(client, command, now);
    case Verb::kDisarm:
      return stop(client, command, now);
    case Verb::kRelease:
      give_lease_back();
      break;
    case Verb::kHold:
    case Verb::kStop:
    case Verb::kPlace:
      valid_until_ = Time::min();
      said_ = now.now;
      break;
  }
  (void)reply(client, command, Outcome::kDone, now);
}

void Commander::take_velocity(std::uint16_t client, const Command& command, const Situation& now) {
  if (!std::isfinite(command.v) || !std::isfinite(command.w))
    return refuse(client, command, Outcome::kInvalid, "v and w must be numbers", now);
  if (command.valid_for <= Duration{} || command.valid_for > Command::kMostValid)
    return refuse(client, command, Outcome::kInvalid, "a velocity is valid for 200 ms at most", now);
  if (command.sent > now.now + kAhead)
    return refuse(client, command, Outcome::kStale, "sent in the future: not by this machine's monotonic clock", now);
  if (now.now - command.sent >= command.valid_for)
    return refuse(client, command, Outcome::kStale, "it was no longer valid when it came", now);
  if (moving_.client != 0) refuse(moving_.client, moving_.command, Outcome::kReplaced, "", now);
  moving_ = {client, command, now.now};
  velocity_ = {.v = command.v, .w = command.w};
  said_ = now.now;
  valid_until_ = std::min(command.sent, now.now) + command.valid_for;
}

void Commander::take_arm(std::uint16_t client, const Command& command, const Situation& now) {
  if (can_move(now)) {
    (void)reply(client, command, Outcome::kDone, now);
    return;
  }
  if (command.epoch != now.decision.epoch)
    return refuse(client, command, Outcome::kRefused, "the robot stopped again since: ask with the epoch of now", now);
  if (!now.decision.blocking.empty()) {
    if (Answer* answer = reply(client, command, Outcome::kRefused, now))
      tell_faults(now.decision.blocking, answer->why);
    return;
  }
  arming_ = {client, command, now.now};
  orders_.arm = command.epoch;
}

/// Of two in one tick, the later one is told.
void Commander::take_place(std::uint16_t client, const Command& command, const Situation& now) {
  if (!abilities_.in_team)
    return refuse(client, command, Outcome::kRefused, "this robot is in no team: the core runs without --peers", now);
  if (!command.place.possible())
    return refuse(client, command, Outcome::kInvalid, "a place is within 100 km, known to 1 cm at best", now);
  orders_.place = command.place;
  (void)reply(client, command, Outcome::kDone, now);
}

void Commander::stop(std::uint16_t client, const Command& command, const Situation& now) {
  orders_.stop = true;
  orders_.arm.reset();
  said_.reset();
  if (Answer* answer = reply(client, command, Outcome::kDone, now)) answer->stopped = true;
}

Commander::Orders Commander::take_orders() { return std::exchange(orders_, {}); }

std::optional<DriveCommand> Commander::wanted(Time now) const {
  if (!said_ || now - *said_ > kLease) return std::nullopt;
  // Without a valid one it stands still at once: the drive's own time-out is longer.
  return now < valid_until_ ? velocity_ : DriveCommand{};
}

void Commander::conclude(const Situation& now, const DriveCommand& told) {
  conclude_arming(now);
  conclude_velocity(now, told);
  if (!can_move(now)) said_.reset();  // what was wanted before a stop must not move the robot after it
}

void Commander::conclude_arming(const Situation& now) {
  if (arming_.client == 0) return;
  const bool done = can_move(now) && now.drive.cause != DriveCause::kEnabling;
  const bool refused = now.now - arming_.at > kArming || !now.decision.blocking.empty();
  if (!done && !refused) return;
  Answer* answer = reply(arming_.client, arming_.command, done ? Outcome::kDone : Outcome::kRefused, now);
  if (answer != nullptr && !done) tell_state(now.decision, now.drive, answer->why);
  arming_ = {};
}

void Commander::conclude_velocity(const Situation& now, const DriveCommand& told) {
  if (moving_.client == 0) return;
  const Command& asked = moving_.command;
  const bool held =
      !can_move(now) || now.drive.level != DriveLevel::kNormal || now.decision.mode == safety::Mode::kHold;
  const bool limited = told.v != asked.v || told.w != asked.w;
  const Outcome outcome = held ? Outcome::kHeld : limited ? Outcome::kLimited : Outcome::kDone;
  if (Answer* answer = reply(moving_.client, asked, outcome, now)) {
    answer->v = held ? 0 : told.v;
    answer->w = held ? 0 : told.w;
    if (outcome != Outcome::kDone) tell_state(now.decision, now.drive, answer->why);
    if (outcome == Outcome::kLimited && answer->why.empty()) answer->why.append("faster than the drive's limits");
  }
  moving_ = {};
}

}  // namespace cairn::app
