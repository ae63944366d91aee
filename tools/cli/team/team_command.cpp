// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/team/team_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "onboard/app/live/stop_signal.hpp"
#include "tools/team/run_team.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

struct TeamCommandOptions {
  team_run::TeamOptions team;
  std::string link = "radio";
  bool json = false;
};

/// This program, and the peer process beside it, unless others are named.
Result<void> find_programs(team_run::TeamOptions& team) {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (team.core.empty()) team.core = self;
  if (team.peers.empty()) team.peers = self.parent_path() / "cairn-peers";
  for (fs::path* program : {&team.core, &team.peers}) {
    *program = fs::absolute(*program, error);
    if (::access(program->c_str(), X_OK) != 0)
      return Error{Errc::kNotFound, "no such program", program->string(), {}, "it is built with cairn"};
  }
  return {};
}

/// One line on a terminal that overwrites itself; nothing elsewhere.
std::function<void(double, double)> team_progress_line() {
  if (::isatty(STDERR_FILENO) == 0) return {};
  return [shown = -1](double seconds, double of) mutable {
    if (static_cast<int>(seconds) == shown) return;
    shown = static_cast<int>(seconds);
    std::fprintf(stderr, "\rt = %d s of %.0f s ", shown, of);
  };
}

int run(TeamCommandOptions options) {
  auto link = team_run::load_link(options.link);
  if (!link) return app::fail(link.error());
  options.team.link = *link;
  if (const auto found = find_programs(options.team); !found) return app::fail(found.error());
  app::catch_stop_signals();
  options.team.stop = app::stop_requested;
  options.team.say = [](const std::string& line) { std::cerr << "cairn team: " << line << '\n'; };
  options.team.progress = team_progress_line();
  const auto outcome = run_team(options.team);
  if (options.team.progress) std::cerr << '\n';
  if (!outcome) return app::fail(outcome.error());
  std::cout << (options.json ? outcome->json : outcome->table);
  return outcome->sound ? app::kDone : app::kFailed;
}

}  // namespace

void add_team_command(app::Commands& commands) {
  CLI::App* sub = commands.app.add_subcommand(
      "team", "runs several robots on this machine, joined by an emulated radio, and compares their team maps");
  const auto options = std::make_shared<TeamCommandOptions>();
  team_run::TeamOptions& team = options->team;
  sub->add_option("--recordings", team.recordings, "one recording per robot, or folders of recordings")->required();
  sub->add_option("--out", team.out, "new folder: gets one folder per robot, team.json and team.png")->required();
  sub->add_option("--link", options->link, "the radio: a link.yaml, radio (2 Mbit/s, 20 % loss) or clean")
      ->capture_default_str();
  sub->add_option("--config", team.config,
                  "profile of every robot; without it: those of the recordings, or the defaults");
  sub->add_option("--resolution", team.resolution_m, "edge of the maps' voxels, m; default: as the profile says")
      ->check(CLI::Range(0.01, 5.0));
  sub->add_option("--settle", team.settle_s, "time that robots go on after the longest recording, s")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  sub->add_option("--kill-peers", team.kills,
                  "how often each peer process is killed; the times follow from the link's seed")
      ->check(CLI::Range(0, 10'000));
  sub->add_flag("--loopback", team.loopback, "use no network namespaces, even where they are allowed");
  sub->add_option("--core", team.core, "another program than this one as the robots' cores")->group("");
  sub->add_option("--peers", team.peers, "another program than the cairn-peers beside this one")->group("");
  sub->add_flag("--overwrite", team.overwrite, "replace the results of an earlier run in --out; other files stay");
  sub->add_flag("--json", options->json, "one JSON object on stdout");
  sub->callback([&commands, options] { commands.job = [options] { return run(*options); }; });
}

}  // namespace cairn::cli
