// SPDX-License-Identifier: Apache-2.0
#include "tools/team/run_team.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/recording/formats/recording.hpp"
#include "hal/clock.hpp"
#include "hal/files/file.hpp"
#include "hal/files/unfinished_folder.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/team/figures/team_figures.hpp"
#include "tools/team/figures/team_picture.hpp"
#include "tools/team/figures/team_recordings.hpp"
#include "tools/team/network/network.hpp"
#include "tools/team/supervisor.hpp"
#include "tools/team/team_report.hpp"

namespace cairn::team_run {
namespace {

namespace fs = std::filesystem;

/// The robots, and how long they run.
struct Plan {
  std::vector<TeamRecording> recordings;
  std::vector<fs::path> folders;
  double seconds = 0;
};

Result<void> refuse_recording(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder / recording::kIndexFile, error)) return {};
  return Error{
      Errc::kInvalidConfig, "the folder for the robot is a recording", folder.string(), {}, "choose another --out"};
}

/// A robot's folder, without what an earlier run left there: it must not be taken for this one's.
Result<void> make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{Errc::kIo, "cannot make the folder", folder.string(), {}, error.message()};
  for (const char* name : {"report.json", "trajectory.tum", "team.cairn", "core.log", "cairn-peers.log"})
    fs::remove(folder / name, error);
  return {};
}

/// Writes each robot's profile into its folder.
Result<void> write_profiles(const TeamOptions& options, const Plan& plan) {
  for (Index i = 0; i < plan.recordings.size(); ++i) {
    auto chosen = app::choose_profile(options.config, plan.recordings[i].folder);
    if (!chosen) return chosen.error();
    app::RobotProfile& profile = chosen->profile;
    if (options.resolution_m > 0) profile.mapping.resolution_m = options.resolution_m;
    profile.name = plan.recordings[i].name;
    profile.team.id = static_cast<int>(i) + 1;
    profile.team.socket = kCoreSocket;
    if (auto kept = app::keep_profile(plan.folders[i], profile); !kept) return kept;
  }
  return {};
}

Result<Plan> prepare(const TeamOptions& options) {
  auto recordings = survey_recordings(options.recordings);
  if (!recordings) return recordings.error();
  Plan plan{*std::move(recordings), {}, 0};
  for (const TeamRecording& recording : plan.recordings) {
    plan.seconds = std::max(plan.seconds, to_seconds(recording.length) + options.settle_s);
    plan.folders.push_back(fs::absolute(options.out) / recording.name);
    if (const auto fit = refuse_recording(plan.folders.back()); !fit) return fit.error();
  }
  if (!options.overwrite)
    if (const auto fit = require_new_folder(options.out, "choose another --out, or add --overwrite"); !fit)
      return fit.error();
  for (const fs::path& folder : plan.folders)
    if (const auto made = make_folder(folder); !made) return made.error();
  if (const auto written = write_profiles(options, plan); !written) return written.error();
  return plan;
}

Result<std::unique_ptr<Network>> make_network(const TeamOptions& options, const Plan& plan) {
  if (options.loopback) return make_loopback_network(options.link, plan.folders);
  auto network = make_tun_network(options.link, plan.folders.size());
  if (network) return network;
  options.say(to_string(network.error()) + "; the robots share this machine's loopback instead");
  return make_loopback_network(options.link, plan.folders);
}

Supervision supervision_of(const TeamOptions& options, const Plan& plan, const Network& network) {
  Supervision what;
  for (Index i = 0; i < plan.recordings.size(); ++i) {
    const fs::path& folder = plan.folders[i];
    const auto command = [&](std::vector<std::string> words, const char* log, int orphaned) {
      return Command{std::move(words), folder, folder / log, network.namespace_of(i), orphaned};
    };
    std::vector<std::string> peers{options.peers.string(), "--robot", std::to_string(i + 1)};
    for (std::string& word : network.peer_arguments(i)) peers.push_back(std::move(word));
    what.robots.push_back({plan.recordings[i].name,
                           command({options.core.string(), "run", "--config", "profile.yaml", "--recording",
                                    plan.recordings[i].folder.string(), "--peers", "--seconds",
                                    fmt::format("{:.1f}", plan.seconds), "--out", "."},
                                   "core.log", SIGTERM),  // it takes its socket away then
                           command(std::move(peers), "cairn-peers.log", SIGKILL)});
  }
  what.kills = plan_kills(static_cast<std::uint64_t>(options.link.seed), plan.folders.size(), options.kills,
                          from_seconds(std::max(1.0, plan.seconds - options.settle_s)));
  what.longest = from_seconds(plan.seconds + 120);
  what.say = options.say;
  what.stop = options.stop;
  if (options.progress) what.progress = [&](Duration age) { options.progress(to_seconds(age), plan.seconds); };
  return what;
}

/// What a program said last.
std::string last_line(const fs::path& log) {
  std::ifstream in(log);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last;
}

/// Nothing, or why there is nothing to compare: in the words of the core that failed, not of one that was ended for it.
Result<void> check(const Plan& plan, const TeamEnd& end) {
  if (end.failed) {
    const fs::path log = plan.folders[*end.failed] / "core.log";
    return Error{Errc::kIo,
                 "a robot's core failed",
                 plan.recordings[*end.failed].name,
                 {},
                 fmt::format("exit code {}, last words: {} ({})", end.robots[*end.failed].exit_code, last_line(log),
                             log.string())};
  }
  if (end.stopped) return Error{Errc::kIo, "the run was ended early"};
  return {};
}

Result<std::vector<RobotResult>> collect(const Plan& plan) {
  std::vector<std::string> names;
  for (const TeamRecording& recording : plan.recordings) names.push_back(recording.name);
  std::vector<RobotResult> results;
  for (Index i = 0; i < plan.recordings.size(); ++i) {
    auto result = read_robot_result(plan.folders[i], plan.recordings[i].folder, names);
    if (!result) return result.error();
    results.push_back(*std::move(result));
  }
  return results;
}

Result<void> save_picture(const std::vector<RobotResult>& robots, const fs::path& path) {
  const auto png = draw_team(robots);
  if (!png) return png.error();
  return write_file_atomic(path, *png);
}

Result<TeamOutcome> compare(const TeamOptions& options, const Plan& plan, const Network& network, const TeamEnd& end) {
  const auto robots = collect(plan);
  if (!robots) return robots.error();
  const auto world = mapping::load_map(plan.recordings.front().folder / "world.ot");
  const TeamFigures figures = compare_team(*robots, world ? world->get() : nullptr);
  const TeamReport report{plan.recordings, network, end, figures};
  TeamOutcome outcome{report::to_text(to_json(report)), to_table(report), figures.sound()};
  if (const auto written = write_file_atomic(options.out / "team.json", outcome.json); !written) return written.error();
  if (const auto saved = save_picture(*robots, options.out / "team.png"); !saved) options.say(to_string(saved.error()));
  return outcome;
}

}  // namespace

Result<TeamOutcome> run_team(const TeamOptions& options) {
  const auto plan = prepare(options);
  if (!plan) return plan.error();
  const auto network = make_network(options, *plan);
  if (!network) return network.error();
  const LiveClock clock;
  const auto end = supervise(supervision_of(options, *plan, **network), **network, clock);
  if (!end) return end.error();
  if (const auto good = check(*plan, *end); !good) return good.error();
  return compare(options, *plan, **network, *end);
}

}  // namespace cairn::team_run
