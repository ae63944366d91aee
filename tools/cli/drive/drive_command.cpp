// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/drive/drive_command.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "drivers/clients/commands/command_client.hpp"
#include "hal/clock.hpp"
#include "onboard/app/live/stop_signal.hpp"
#include "onboard/safety/fault.hpp"
#include "tools/cli/drive/answer_text.hpp"
#include "tools/cli/drive/connect_robot.hpp"
#include "tools/cli/drive/place_command.hpp"

namespace cairn::cli {
namespace {

using clients::Answer;
using clients::Command;
using clients::CommandClient;

// Enabling motors takes up to three seconds.
constexpr Duration kPatience = std::chrono::seconds(5);
// A velocity is valid for 200 ms: two may be late or lost.
constexpr Duration kPeriod = std::chrono::milliseconds(50);

struct Asked {
  std::filesystem::path socket;
  bool json = false;
};

struct DriveArguments {
  Asked asked;
  double v = 0, omega = 0, seconds = 0;
};

int show(const Answer& answer, bool json) {
  if (json)
    app::print(json_of(answer));
  else
    std::cout << text_of(answer) << "\n";
  return answer.outcome == Answer::Outcome::kDone || answer.outcome == Answer::Outcome::kLimited ? app::kDone
                                                                                                 : app::kFailed;
}

/// One command and its answer.
int ask(const Asked& a, Command::Verb verb) {
  const LiveClock clock;
  auto robot = connect_robot(a.socket, "cairn " + std::string(to_string(verb)), clock);
  if (!robot) return app::fail(robot.error());
  const auto answer = robot->ask({.verb = verb, .epoch = robot->last().epoch, .who = {}}, kPatience);
  return answer ? show(*answer, a.json) : app::fail(answer.error());
}

/// Reads answers until `until`, and says on stderr when they change. Fails when the core has gone.
Result<void> listen(CommandClient& robot, Time until, const Clock& clock, std::optional<Answer::Outcome>& said) {
  while (clock.now() < until) {
    const auto answer = robot.next_answer(until - clock.now());
    if (!answer && answer.error().code == Errc::kNotFound) return {};
    if (!answer) return answer.error();
    if (answer->outcome == Answer::Outcome::kReplaced || said == answer->outcome) continue;
    said = answer->outcome;
    std::cerr << text_of(*answer) << "\n";
  }
  return {};
}

/// Why a robot whose greeting says that it is stopped is not driven, and what lets it move.
Error stopped(const Answer& greeting, std::string socket) {
  const std::string why(greeting.why.view());
  if (why.find(to_string(safety::Fault::kEStopOpen)) != std::string::npos)
    return {Errc::kLinkDown, "stopped by the e-stop", std::move(socket), {}, "release it, then `cairn arm`"};
  return {Errc::kLinkDown, "the robot is stopped", std::move(socket), {}, why + "; `cairn arm` lets it move"};
}

int drive(const DriveArguments& a) {
  const LiveClock clock;
  auto robot = connect_robot(a.asked.socket, "cairn drive", clock);
  if (!robot) return app::fail(robot.error());
  if (robot->last().stopped) return app::fail(stopped(robot->last(), a.asked.socket.string()));
  app::catch_stop_signals();
  std::optional<Answer::Outcome> said;
  const Time end = clock.now() + from_seconds(a.seconds);
  for (Time next = clock.now(); next < end && !app::stop_requested(); next += kPeriod) {
    if (!robot->drive(a.v, a.omega)) break;
    if (const auto heard = listen(*robot, std::min(next + kPeriod, end), clock, said); !heard)
      return app::fail(heard.error());
  }
  const Answer last = robot->last();
  const auto held = robot->ask({.verb = Command::Verb::kHold, .who = {}}, kPatience);
  if (!held) return app::fail(held.error());
  if (app::stop_requested()) return app::fail(app::interrupted("cairn drive", "the robot holds"));
  if (!a.asked.json && said == last.outcome && said != Answer::Outcome::kDone && said != Answer::Outcome::kLimited)
    return app::kFailed;  // stderr has it already
  return show(last, a.asked.json);
}

std::shared_ptr<Asked> add_ask(app::Commands& commands, const char* name, const char* what, Command::Verb verb) {
  auto* sub = commands.app.add_subcommand(name, what);
  auto a = std::make_shared<Asked>();
  add_socket_option(*sub, a->socket);
  sub->add_flag("--json", a->json, "print the answer as JSON");
  sub->callback([&commands, a, verb] { commands.job = [a, verb] { return ask(*a, verb); }; });
  return a;
}

std::string finite(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) && std::isfinite(value) ? "" : "this is no number: " + text;
}

}  // namespace

void add_drive_commands(app::Commands& commands) {
  add_ask(commands, "arm", "lets a stopped robot move again, and enables its motors", Command::Verb::kArm);
  add_ask(commands, "stop", "stops a robot at once, until somebody arms it; open to every client",
          Command::Verb::kStop);
  add_ask(commands, "disarm", "stops a robot and disables its motors; only for the client that commands it",
          Command::Verb::kDisarm);
  auto* sub = commands.app.add_subcommand("drive", "moves a running robot with one velocity for a time");
  auto a = std::make_shared<DriveArguments>();
  add_socket_option(*sub, a->asked.socket);
  sub->add_option("--v", a->v, "m/s, forward")->check(finite)->default_val(0.0);
  sub->add_option("--omega", a->omega, "rad/s, to the left")->check(finite)->default_val(0.0);
  sub->add_option("--seconds", a->seconds, "how long")->check(app::above_zero)->required();
  sub->add_flag("--json", a->asked.json, "print the last answer as JSON");
  sub->callback([&commands, a] { commands.job = [a] { return drive(*a); }; });
  add_place_command(commands);
}

}  // namespace cairn::cli
