// SPDX-License-Identifier: Apache-2.0
// The steps of tools/protocol.sh and tools/protocol_people.sh that need no PCL: protocol pairs | match | report, and
// missions | match | people.
#include <CLI/CLI.hpp>
#include <iostream>

#include "tools/protocol/methods/run_methods.hpp"
#include "tools/protocol/missions/mission_pairs.hpp"
#include "tools/protocol/missions/mission_report.hpp"
#include "tools/protocol/pairs/make_pairs.hpp"
#include "tools/protocol/report/report.hpp"

namespace {

namespace fs = std::filesystem;
using namespace cairn;
using namespace cairn::protocol;

/// All methods that the kind of pair asks for where none are named.
Result<void> match(const fs::path& dir, std::vector<std::string> methods, int starts) {
  const auto pair = load_pair(dir);
  if (!pair) return pair.error();
  if (methods.empty()) methods = our_methods(*pair);
  std::vector<MethodRun> runs;
  for (const std::string& method : methods) {
    auto run = run_method(*pair, method, is_fast(method) ? kStarts : starts);
    if (!run) return at(method, run.error());
    runs.push_back(*std::move(run));
  }
  return save_runs(runs, dir / "ours.json");
}

int outcome(const Result<void>& result) {
  if (result) return 0;
  std::cerr << "protocol: " << to_string(result.error()) << '\n';
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"the book's protocol of map matching, in steps; see tools/protocol.sh", "protocol"};
  app.require_subcommand(1);
  PairsOptions pairs;
  CLI::App* make = app.add_subcommand("pairs", "recordings → pairs of maps");
  make->add_option("--recordings", pairs.recordings, "folder of simulated recordings")->required();
  make->add_option("--octomaps", pairs.octomaps, "folder of maps to be cut in halves, too");
  make->add_option("--seed", pairs.seed, "of the halves' faults");
  make->add_option("--out", pairs.out, "gets a folder for each pair")->required();
  fs::path dir;
  std::vector<std::string> methods;
  int starts = kStarts;
  CLI::App* run = app.add_subcommand("match", "matches one pair by our methods, leaves ours.json in its folder");
  run->add_option("pair", dir, "folder of the pair")->required();
  run->add_option("--method", methods, "only these");
  run->add_option("--starts", starts, "so many of the 125, for methods that take long")->check(CLI::Range(1, kStarts));
  fs::path results, out;
  unsigned seed = 1;
  CLI::App* tell = app.add_subcommand("report", "pairs with their outcomes → protocol.json and protocol.html");
  tell->add_option("--pairs", results, "folder of the pairs")->required();
  tell->add_option("--seed", seed, "to be told");
  tell->add_option("--out", out, "folder of the report")->required();
  MissionsOptions missions;
  CLI::App* pair_up = app.add_subcommand("missions", "runs of two robots among people → pairs of maps");
  pair_up->add_option("--recordings", missions.recordings, "LIGHT/robot_N")->required();
  pair_up->add_option("--runs", missions.runs, "LIGHT/PIPELINE/PHASE/robot_N")->required();
  pair_up->add_option("--out", missions.out, "gets a folder for each pair")->required();
  fs::path pictures;
  CLI::App* people = app.add_subcommand("people", "pairs of missions with their outcomes → people.json, people.html");
  people->add_option("--pairs", results, "folder of the pairs")->required();
  people->add_option("--pictures", pictures, "folder of PNG files to be shown");
  people->add_option("--seed", seed, "to be told");
  people->add_option("--out", out, "folder of the report")->required();
  CLI11_PARSE(app, argc, argv);
  if (*make) return outcome(make_pairs(pairs));
  if (*run) return outcome(match(dir, methods, starts));
  if (*pair_up) return outcome(make_missions(missions));
  if (*people) return outcome(write_missions(results, pictures, seed, out));
  return outcome(write_report(results, seed, out));
}
