// SPDX-License-Identifier: Apache-2.0
// The steps of tools/protocol*.sh that need no PCL: protocol pairs | match | report, missions | match | people, and
// unlike-pairs | match | unlike.
#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>

#include "tools/protocol/methods/run_methods.hpp"
#include "tools/protocol/missions/mission_pairs.hpp"
#include "tools/protocol/missions/mission_report.hpp"
#include "tools/protocol/pairs/make_pairs.hpp"
#include "tools/protocol/report/report.hpp"
#include "tools/protocol/unlike/unlike_pairs.hpp"
#include "tools/protocol/unlike/unlike_report.hpp"

namespace {

namespace fs = std::filesystem;
using namespace cairn;
using namespace cairn::protocol;

/// What the command line asks for.
struct Options {
  PairsOptions pairs;
  MissionsOptions missions;
  UnlikeOptions unlike;
  fs::path pair;  ///< to be matched
  std::vector<std::string> methods;
  int starts = kStarts;
  fs::path results, pictures, out;
  unsigned seed = 1;
  std::function<Result<void>()> job;
};

/// All methods that the kind of pair asks for where none are named.
Result<void> match(const fs::path& dir, std::vector<std::string> methods, int starts) {
  const auto pair = load_pair(dir);
  if (!pair) return pair.error();
  if (methods.empty()) methods = our_methods(*pair);
  std::vector<MethodRun> runs;
  for (const std::string& method : methods) {
    auto run = run_method(*pair, method, is_fast(method) && pair->kind != kUnlike ? kStarts : starts);
    if (!run) return at(method, run.error());
    runs.push_back(*std::move(run));
  }
  return save_runs(runs, dir / "ours.json");
}

void add_match(CLI::App& app, Options& o) {
  CLI::App* sub = app.add_subcommand("match", "matches one pair by our methods, leaves ours.json in its folder");
  sub->add_option("pair", o.pair, "folder of the pair")->required();
  sub->add_option("--method", o.methods, "only these");
  sub->add_option("--starts", o.starts, "so many of the 125; what is fast gets all, but for unlike robots")
      ->check(CLI::Range(1, kStarts));
  sub->callback([&o] { o.job = [&o] { return match(o.pair, o.methods, o.starts); }; });
}

/// With the options that all reports have.
CLI::App& add_report(CLI::App& app, const char* name, const char* what, Options& o) {
  CLI::App* sub = app.add_subcommand(name, what);
  sub->add_option("--pairs", o.results, "folder of the pairs")->required();
  sub->add_option("--seed", o.seed, "to be told");
  sub->add_option("--out", o.out, "folder of the report")->required();
  return *sub;
}

void add_book(CLI::App& app, Options& o) {
  CLI::App* make = app.add_subcommand("pairs", "recordings → pairs of maps");
  make->add_option("--recordings", o.pairs.recordings, "folder of simulated recordings")->required();
  make->add_option("--octomaps", o.pairs.octomaps, "folder of maps to be cut in halves, too");
  make->add_option("--seed", o.pairs.seed, "of the halves' faults");
  make->add_option("--out", o.pairs.out, "gets a folder for each pair")->required();
  make->callback([&o] { o.job = [&o] { return make_pairs(o.pairs); }; });
  add_report(app, "report", "pairs with their outcomes → protocol.json and protocol.html", o).callback([&o] {
    o.job = [&o] { return write_report(o.results, o.seed, o.out); };
  });
}

void add_missions(CLI::App& app, Options& o) {
  CLI::App* make = app.add_subcommand("missions", "runs of two robots among people → pairs of maps");
  make->add_option("--recordings", o.missions.recordings, "LIGHT/robot_N")->required();
  make->add_option("--runs", o.missions.runs, "LIGHT/PIPELINE/PHASE/robot_N")->required();
  make->add_option("--out", o.missions.out, "gets a folder for each pair")->required();
  make->callback([&o] { o.job = [&o] { return make_missions(o.missions); }; });
  CLI::App& tell = add_report(app, "people", "pairs of missions with their outcomes → people.json, people.html", o);
  tell.add_option("--pictures", o.pictures, "folder of PNG files to be shown");
  tell.callback([&o] { o.job = [&o] { return write_missions(o.results, o.pictures, o.seed, o.out); }; });
}

void add_unlike(CLI::App& app, Options& o) {
  CLI::App* make = app.add_subcommand("unlike-pairs", "runs of a UGV and a UAV → pairs of maps");
  make->add_option("--recordings", o.unlike.recordings, "SCENE/ugv_1 and SCENE/uav_1")->required();
  make->add_option("--runs", o.unlike.runs, "SCENE/N/ugv_1 and SCENE/N/uav_1")->required();
  make->add_option("--out", o.unlike.out, "gets a folder for each pair")->required();
  make->callback([&o] { o.job = [&o] { return make_unlike(o.unlike); }; });
  add_report(app, "unlike", "pairs of UGV and UAV with their outcomes → unlike.json, unlike.html", o).callback([&o] {
    o.job = [&o] { return write_unlike(o.results, o.seed, o.out); };
  });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"the book's protocols, in steps; see tools/protocol*.sh", "protocol"};
  app.require_subcommand(1);
  Options options;
  add_match(app, options);
  add_book(app, options);
  add_missions(app, options);
  add_unlike(app, options);
  CLI11_PARSE(app, argc, argv);
  const auto done = options.job();
  if (done) return 0;
  std::cerr << "protocol: " << to_string(done.error()) << '\n';
  return 1;
}
