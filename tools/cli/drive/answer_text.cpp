// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/drive/answer_text.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "onboard/safety/fault.hpp"

namespace cairn::cli {
namespace {

using Outcome = clients::Answer::Outcome;

std::string head_of(const clients::Answer& a) {
  switch (a.outcome) {
    case Outcome::kDone:
      if (a.stopped) return "done: the robot is stopped, and moves when it is armed";
      return fmt::format("done: {:.2f} m/s, {:.2f} rad/s", a.v, a.w);
    case Outcome::kLimited:
      return fmt::format("limited to {:.2f} m/s, {:.2f} rad/s", a.v, a.w);
    case Outcome::kHeld:
      return a.stopped ? "the robot does not move, it is stopped" : "the robot does not move now";
    case Outcome::kNotHolder:
      return fmt::format("not done: \"{}\" commands the robot now", a.holder.view());
    case Outcome::kStale:
      return "not done: too late";
    case Outcome::kInvalid:
      return "not done: no such command";
    case Outcome::kRefused:
      return "the robot cannot be armed";
    case Outcome::kReplaced:
      return "replaced by a later command";
  }
  return "unknown answer";
}

/// What a core says of a robot that nothing holds but its motors.
std::string being_enabled() {
  return fmt::format("{}: {}", to_string(safety::Mode::kHold), to_string(safety::Fault::kDriveNotReady));
}

}  // namespace

std::string text_of(const clients::Answer& answer) {
  if (answer.outcome == Outcome::kHeld && !answer.stopped && answer.why.view() == being_enabled())
    return "the motors are being enabled: the robot waits";
  std::string text = head_of(answer);
  if (!answer.why.empty()) text.append(": ").append(answer.why.view());
  return text;
}

nlohmann::ordered_json json_of(const clients::Answer& a) {
  return {{"outcome", to_string(a.outcome)}, {"stopped", a.stopped}, {"epoch", a.epoch}, {"v", a.v}, {"omega", a.w},
          {"holder", a.holder.view()},       {"why", a.why.view()}};
}

void add_socket_option(CLI::App& app, std::filesystem::path& socket) {
  app.add_option("--socket", socket, "command.sock of the core: in the folder of its --sockets")
      ->default_val("/run/cairn/command.sock");
}

}  // namespace cairn::cli
