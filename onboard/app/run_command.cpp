// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/run_command.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "onboard/app/budget_fields.hpp"
#include "onboard/app/live/stop_signal.hpp"
#include "onboard/app/print_tasks.hpp"
#include "onboard/app/run.hpp"
#include "onboard/report/json/budgets.hpp"
#include "onboard/report/json/report_json.hpp"
#include "onboard/report/summary.hpp"

namespace cairn::app {
namespace {

struct Arguments {
  RunOptions run;
  std::filesystem::path budgets;
  std::string speed = "real", networks = "run";
  bool json = false;
  bool print_tasks = false;
};

void show_progress(Time now, std::size_t scans) {
  if (scans % 10 == 0) std::fprintf(stderr, "\r%zu scans, t = %.1f s ", scans, to_seconds(now));
}

void print_summary(const report::RunReport& r, const std::filesystem::path& out) {
  std::printf("%s  output_sha256 %s\n  %s\n", report::to_summary(r).c_str(), r.output_sha256.c_str(),
              (out / "report.html").c_str());
}

/// Prints the table; the exit code says whether everything was kept.
int judge(const std::vector<report::BudgetLimit>& limits, const report::RunReport& report) {
  const auto verdicts = report::check_budgets(limits, report::to_json(report));
  if (!verdicts) return fail(at(limits.front().file, verdicts.error()));
  std::fprintf(stderr, "%s", report::to_table(*verdicts).c_str());
  const auto kept = report::all_kept(*verdicts);
  return kept ? kDone : fail(at(limits.front().file + ", " + report.robot, kept.error()));
}

int show_tasks(const RunOptions& options, bool json) {
  if (json) {
    const auto tasks = tasks_as_json(options);
    if (!tasks) return fail(tasks.error());
    return print(*tasks);
  }
  const auto text = cairn::app::print_tasks(options);
  if (!text) return fail(text.error());
  std::printf("%s", text->c_str());
  return kDone;
}

/// What became of the results of an earlier run.
std::string kept_results(const RunResult& result, const std::filesystem::path& out) {
  if (result.folder == out) return {};
  return "; the earlier results in " + out.string() + " are kept, those of this run are in " + result.folder.string();
}

NetworkUse network_use(const std::string& word) {
  return word == "off" ? NetworkUse::kOff : word == "recorded" ? NetworkUse::kRecorded : NetworkUse::kRun;
}

/// A pace that the kind of run cannot have.
Result<void> check_speed(const Arguments& a) {
  if (a.speed != "max") return {};
  if (a.run.peers)
    return Error{Errc::kInvalidConfig,
                 "peers are spoken to in real time",
                 "--speed max",
                 {},
                 "leave out --peers: what peers said then is in the recording"};
  if (a.run.recording.empty())
    return Error{Errc::kInvalidConfig,
                 "a live run has the speed of time",
                 "--speed max",
                 {},
                 "name a --recording, or leave it out"};
  return {};
}

/// Nothing without --assert.
Result<std::vector<report::BudgetLimit>> limits_of(const Arguments& a) {
  if (a.budgets.empty()) return std::vector<report::BudgetLimit>();
  auto limits = report::load_budgets(a.budgets);
  if (!limits) return limits;
  if (const auto fits = check_budget_fields(*limits, a.run); !fits) return at(a.budgets.string(), fits.error());
  return limits;
}

int run_robot(Arguments a) {
  a.run.networks = network_use(a.networks);
  if (const auto fits = check_speed(a); !fits) return fail(fits.error());
  const auto limits = limits_of(a);
  if (!limits) return fail(limits.error());
  a.run.reference = !limits->empty();
  a.run.pace = a.run.live() ? Pace::kLive : a.speed == "max" ? Pace::kMaximum : Pace::kRecorded;
  if (a.print_tasks) return show_tasks(a.run, a.json);
  if (::isatty(STDERR_FILENO) != 0) a.run.progress = show_progress;
  catch_stop_signals();
  a.run.stop = stop_requested;
  const auto result = cairn::app::run(a.run);
  if (a.run.progress) std::fputc('\n', stderr);
  if (!result) return fail(result.error());
  const report::RunReport& report = (*result)->report;
  if (a.json)
    print(report::to_json(report));
  else
    print_summary(report, (*result)->folder);
  if (report.interrupted) return fail(interrupted(report.source, "run it again for all of it"));
  if (report.scans != 0) return limits->empty() ? kDone : judge(*limits, report);
  const std::string remedy = report.live ? "see the events; `cairn doctor --config PROFILE` listens to the devices"
                                         : "see the events; `cairn inspect` says what a recording holds";
  const char* const nothing = report.visual_odometry ? "not one stereo picture came in" : "not one scan came in";
  return fail({Errc::kNotFound, nothing, report.source, {}, remedy + kept_results(**result, a.run.out)});
}

}  // namespace

void add_run_command(Commands& commands) {
  add_run_options(*commands.app.add_subcommand("run", "runs one robot: on live hardware, or on a recording"), commands);
}

void add_run_options(CLI::App& app, Commands& commands) {
  auto a = std::make_shared<Arguments>();
  app.add_option("--config", a->run.config,
                 "robot profile, such as config/husky.yaml; without it: that of the recording, or the defaults");
  app.add_option("--recording", a->run.recording, "folder of a recording; without it: live hardware");
  app.add_option("--out", a->run.out, "folder for the results")->default_val("cairn-out");
  app.add_option("--record", a->run.record,
                 "live: keep every packet and the schedule in this folder; a replay of it gives the same bits");
  app.add_option(
      "--state", a->run.state,
      "live: keep map and pose in this folder; after a crash, the next run goes on from there (profile: restart)");
  app.add_flag(
      "--peers", a->run.peers,
      "take part in the team, through the peer process (cairn-peers) at team.socket of the profile; a recording is "
      "played as if by the robot's devices");
  app.add_option("--live-view", a->run.live_view, "live: local socket for cairn top, such as /run/cairn/live.sock");
  app.add_option(
      "--sockets", a->run.sockets,
      "live: folder for the sockets of other programs, such as /run/cairn: robot.sock gives pose, state, maps "
      "and scans, command.sock takes commands");
  app.add_option("--schedule", a->run.schedule,
                 "repeat this schedule.log of a live run, instead of the recording's own");
  app.add_option("--speed", a->speed, "pace of a recording: as it was made, or as fast as possible")
      ->check(CLI::IsMember({"real", "max"}))
      ->default_val("real");
  app.add_option("--networks", a->networks,
                 "who labels pictures: nobody (off), the networks of the profile (run), or labels/ of the recording")
      ->check(CLI::IsMember({"off", "run", "recorded"}))
      ->default_val("run");
  app.add_option("--assert", a->budgets,
                 "fail when one of these budgets is exceeded, such as config/budgets/husky.yaml");
  app.add_option("--threads", a->run.threads,
                 "threads of a stage, instead of the profile's; the result does not depend on them")
      ->check(CLI::Range(1, 64));
  app.add_option("--seconds", a->run.seconds, "end after so many seconds of the robot's time")->check(above_zero);
  app.add_flag("--json", a->json, "print report.json on stdout; with --print-tasks: the tasks as JSON");
  app.add_flag("--print-tasks", a->print_tasks,
               "print the tasks of the run (rate, priority, budget) and the channels between them, and end");
  app.callback([&commands, a] { commands.job = [a] { return run_robot(*a); }; });
}

}  // namespace cairn::app
