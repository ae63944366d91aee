// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/commands/command_relay.hpp"

#include <utility>

namespace cairn::ros {
namespace {

using clients::Answer;
using clients::Command;

// A core that hangs makes connecting wait: not with each command.
constexpr Duration kRetry = std::chrono::seconds(1);

bool as_asked(const Answer& answer) {
  return answer.outcome == Answer::Outcome::kDone || answer.outcome == Answer::Outcome::kReplaced;
}

}  // namespace

bool CommandRelay::connected() {
  if (client_) return true;
  if (failed_ && clock_->now() - *failed_ < kRetry) return false;
  auto client = clients::CommandClient::connect(socket_, "cairn-ros", *clock_);
  if (!client) {
    failed_ = clock_->now();
    trouble_ = to_string(client.error());
    return false;
  }
  client_.emplace(std::move(*client));
  trouble_.clear();
  return true;
}

void CommandRelay::send(Command command) {
  read_answers();
  if (!connected()) return;
  ++sent_;
  if (client_->send(command)) return;
  client_.reset();
  trouble_ = "the core does not read commands";
}

void CommandRelay::drive(const Velocity& velocity, Duration held_up) {
  const Duration valid_for = Command::kMostValid - held_up;
  if (valid_for <= Duration{}) return refuse("velocity", "this program was busy for too long");
  send({.verb = Command::Verb::kVelocity, .valid_for = valid_for, .v = velocity.v, .w = velocity.w, .who = {}});
}

void CommandRelay::arm(std::uint32_t epoch) { send({.verb = Command::Verb::kArm, .epoch = epoch, .who = {}}); }

void CommandRelay::refuse(std::string_view what, std::string_view why) {
  ++refused_;
  refusal_ = std::string(what) + ": " + std::string(why);
}

void CommandRelay::read_answers() {
  while (client_) {
    const auto answer = client_->next_answer(Duration{});
    if (answer) {
      answer_ = *answer;
      continue;
    }
    if (answer.error().code == Errc::kNotFound) return;
    trouble_ = to_string(answer.error());
    client_.reset();
  }
}

Diagnosis CommandRelay::diagnosis() const {
  Diagnosis diagnosis{.level = DiagnosticLevel::kOk, .name = "commands", .message = "none yet"};
  if (answer_) {
    diagnosis.message = to_string(answer_->outcome);
    if (!answer_->why.empty()) diagnosis.message += ": " + std::string(answer_->why.view());
    if (!as_asked(*answer_)) diagnosis.level = DiagnosticLevel::kWarn;
    diagnosis.values = {{"holder", std::string(answer_->holder.view())},
                        {"v", std::to_string(answer_->v)},
                        {"w", std::to_string(answer_->w)}};
  }
  if (!trouble_.empty()) {
    diagnosis.level = DiagnosticLevel::kError;
    diagnosis.message = trouble_;
  }
  diagnosis.values.emplace_back("passed_on", std::to_string(sent_));
  diagnosis.values.emplace_back("refused_here", std::to_string(refused_));
  if (!refusal_.empty()) diagnosis.values.emplace_back("last_refusal", refusal_);
  return diagnosis;
}

}  // namespace cairn::ros
