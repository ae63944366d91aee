// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "onboard/app/commands/commander.hpp"
#include "tests/support/command_queue.hpp"

namespace cairn::app::test {

using namespace std::chrono_literals;
using clients::Answer;
using clients::Command;
using Outcome = Answer::Outcome;
using Verb = Command::Verb;

inline constexpr std::uint16_t kDesk = 1, kJoystick = 2;

/// A robot that does what it is told, and clients that talk to its commander.
class CommanderRig : public ::testing::Test {
 protected:
  CommanderRig() {
    queue_.join(kDesk, now_);
    queue_.join(kJoystick, now_);
    step();
    moving();
  }
  void moving() {
    decision_ = {};
    decision_.mode = safety::Mode::kNormal;
    decision_.epoch = 3;
    drive_ = {DriveLevel::kNormal, DriveCause::kNone, 1};
  }
  void stopped(safety::FaultSet blocking = {}) {
    decision_.mode = safety::Mode::kStop;
    decision_.active = decision_.blocking = blocking;
    drive_ = {DriveLevel::kStop, DriveCause::kRequested, 1};
  }
  [[nodiscard]] Commander::Situation situation() const { return {now_, decision_, drive_}; }
  /// One tick of the drive task, 10 ms later. Its answers are in queue_.
  void step(Duration later = 10ms) {
    now_ += later;
    queue_.answers.clear();
    Packet packet;
    while (queue_.next(packet, {}).value() == Poll::kPacket) commander_.take(packet, situation());
    orders_ = commander_.take_orders();
    const DriveCommand wanted = commander_.wanted(now_).value_or(DriveCommand{});
    commander_.conclude(situation(), {std::min(wanted.v, most_), wanted.w, 0});
    for (const auto& reply : commander_.replies()) (void)queue_.answer(reply.client, reply.answer);
    commander_.forget_replies();
  }
  void say(std::uint16_t client, Command command) {
    if (command.who.empty()) command.who = clients::ClientName(client == kDesk ? "desk" : "joystick");
    queue_.say(client, now_, command);
  }
  void say_velocity(std::uint16_t client, double v) {
    say(client, {.verb = Verb::kVelocity, .v = v, .w = 0.1, .who = {}});
  }
  void say(std::uint16_t client, Verb verb) { say(client, Command{.verb = verb, .epoch = decision_.epoch, .who = {}}); }
  [[nodiscard]] const Answer& answer() const { return queue_.answers.at(0).answer; }
  [[nodiscard]] double speed() const { return commander_.wanted(now_).value_or(DriveCommand{}).v; }

  support::CommandQueue queue_;
  Commander commander_{{.drives = true, .in_team = true}};
  safety::FailsafeDecision decision_;
  DriveStatus drive_;
  Time now_{100s};
  double most_ = 1;
  Commander::Orders orders_;
};

}  // namespace cairn::app::test
