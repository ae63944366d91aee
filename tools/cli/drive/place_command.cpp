// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/drive/place_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "drivers/clients/commands/command_client.hpp"
#include "hal/clock.hpp"
#include "tools/cli/drive/answer_text.hpp"
#include "tools/cli/drive/connect_robot.hpp"

namespace cairn::cli {
namespace {

using clients::Answer;
using clients::Placement;

constexpr Duration kAnswered = std::chrono::seconds(5);
constexpr double kRadPerDeg = std::numbers::pi / 180;

struct PlaceArguments {
  std::filesystem::path socket;
  std::string frame;
  double x_m = 0, y_m = 0, yaw_deg = 0, sigma_m = 0, sigma_deg = 0;
  bool forget = false, json = false;
};

Placement placement_of(const PlaceArguments& a) {
  if (a.forget) return {};
  return {.frame = clients::ShortText<32>(a.frame == "site" ? "" : a.frame),
          .x = a.x_m,
          .y = a.y_m,
          .yaw = a.yaw_deg * kRadPerDeg,
          .sigma_m = a.sigma_m,
          .sigma_rad = std::min(a.sigma_deg * kRadPerDeg, 3.14)};
}

int place(const PlaceArguments& a) {
  const LiveClock clock;
  auto robot = connect_robot(a.socket, "cairn place", clock);
  if (!robot) return app::fail(robot.error());
  const auto answer =
      robot->ask({.verb = clients::Command::Verb::kPlace, .who = {}, .place = placement_of(a)}, kAnswered);
  if (!answer) return app::fail(answer.error());
  const bool told = answer->outcome == Answer::Outcome::kDone;
  if (a.json)
    app::print(json_of(*answer));
  else if (told)
    std::cout << "the team is told; `cairn doctor --peer all` says what the maps make of it\n";
  else
    std::cout << "not placed: " << answer->why.view() << "\n";
  return told ? app::kDone : app::kFailed;
}

}  // namespace

void add_place_command(app::Commands& commands) {
  auto* sub = commands.app.add_subcommand("place", "tells a running robot where it is among its teammates");
  auto a = std::make_shared<PlaceArguments>();
  add_socket_option(*sub, a->socket);
  auto* forget = sub->add_flag("--forget", a->forget, "take back what was said before");
  sub->add_option("--frame", a->frame,
                  "site: the frame of the team's start poses; team: of the team's map; or a teammate's name: its odom")
      ->default_val("site")
      ->excludes(forget);
  const auto number = [&](const char* name, double& value, const char* what, double least, double most) {
    return sub->add_option(name, value, what)->check(CLI::Range(least, most))->excludes(forget);
  };
  number("--x", a->x_m, "m, of base_link", -Placement::kFarthest_m, Placement::kFarthest_m);
  number("--y", a->y_m, "m, of base_link", -Placement::kFarthest_m, Placement::kFarthest_m);
  number("--yaw", a->yaw_deg, "degrees, from x towards y", -360, 360);
  number("--sigma", a->sigma_m, "m, how sure x and y are: standard deviation", Placement::kLeastSigma_m, 100)
      ->default_val(0.5);
  number("--sigma-yaw", a->sigma_deg, "degrees, how sure yaw is; 180: it is not known", 0.1, 180)->default_val(15);
  sub->add_flag("--json", a->json, "print the answer as JSON");
  sub->callback([&commands, a] { commands.job = [a] { return place(*a); }; });
}

}  // namespace cairn::cli
