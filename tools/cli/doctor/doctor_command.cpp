// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/doctor/doctor_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "onboard/app/cli/working_line.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/doctor/machine.hpp"
#include "tools/cli/doctor/peer.hpp"
#include "tools/cli/doctor/robot.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using Level = Finding::Level;

struct DoctorArguments {
  fs::path config, recording, root = "/";
  std::string peer;
  fs::path run, live_view;
  double seconds = 1;
  bool json = false;
};

Findings examine(const DoctorArguments& options) {
  if (!options.peer.empty())
    return examine_peer(
        {.name = options.peer, .recording = options.recording, .run = options.run, .live_view = options.live_view});
  Findings all;
  const auto add = [&all](Findings more) { std::move(more.begin(), more.end(), std::back_inserter(all)); };
  if (!options.recording.empty()) {
    add(examine_recording(options.recording));
    if (options.config.empty()) return all;
  }
  if (!options.config.empty()) add(examine_profile(options.config, from_seconds(options.seconds)));
  add(examine_cameras(options.root));
  add(examine_can(options.root));
  add(examine_gpio(options.root));
  add(examine_real_time(options.root));
  return all;
}

const char* name_of(Level level) {
  switch (level) {
    case Level::kOk:
      return "ok";
    case Level::kNote:
      return "note";
    case Level::kProblem:
      return "problem";
  }
  return "unknown";
}

void print_lines(const Findings& findings) {
  for (const Finding& f : findings) {
    std::cout << name_of(f.level) << ": " << f.what;
    if (!f.remedy.empty()) std::cout << " → " << f.remedy;
    std::cout << '\n';
  }
}

report::Json to_json(const Findings& findings) {
  report::Json list = report::Json::array();
  for (const Finding& f : findings)
    list.push_back({{"level", name_of(f.level)}, {"what", f.what}, {"remedy", f.remedy}});
  return list;
}

int diagnose(const DoctorArguments& options) {
  std::error_code ignored;
  if (!options.config.empty() && !fs::exists(options.config, ignored))
    return app::fail({Errc::kInvalidConfig, "there is no such profile", options.config.string()});
  const auto findings = app::while_working("examining", [&] { return examine(options); });
  const auto problems =
      std::count_if(findings.begin(), findings.end(), [](const Finding& f) { return f.level == Level::kProblem; });
  if (options.json)
    app::print({{"problems", problems}, {"findings", to_json(findings)}});
  else
    print_lines(findings);
  return problems == 0 ? app::kDone : app::kFailed;
}

}  // namespace

void add_doctor_command(app::Commands& commands) {
  auto* sub = commands.app.add_subcommand(
      "doctor", "says what is wrong with machine, devices, recording or team, and the remedy");
  auto o = std::make_shared<DoctorArguments>();
  auto* config = sub->add_option("--config", o->config, "robot profile: open each of its devices and listen to it");
  sub->add_option("--recording", o->recording, "recording: look for damage, losses and silent sensors");
  auto* peer = sub->add_option(
      "--peer", o->peer,
      "name of a robot of the team, or all: say why it is not merged. Asks the running core, or reads --run or "
      "--recording");
  sub->add_option("--run", o->run, "with --peer: folder of a finished run")->needs(peer);
  sub->add_option("--live-view", o->live_view, "with --peer: socket of the running core, its --live-view")
      ->default_val("/run/cairn/live.sock")
      ->needs(peer);
  auto* seconds = sub->add_option("--seconds", o->seconds, "how long to listen to each device");
  seconds->check(CLI::Range(0.01, 3600.0));
  auto* root = sub->add_option("--root", o->root,
                               "folder with proc, sys and dev to examine instead of /, such as a mounted disk");
  for (CLI::Option* of_machine : {config, seconds, root}) peer->excludes(of_machine);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o] { commands.job = [o] { return diagnose(*o); }; });
}

}  // namespace cairn::cli
