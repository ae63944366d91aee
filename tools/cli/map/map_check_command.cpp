// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/map_check_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "fusion/matching/belief/map_check.hpp"
#include "fusion/matching/matcher.hpp"
#include "onboard/app/cli/working_line.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using matching::MapFeatures;
using matching::SubmapPair;

struct MapCheckOptions {
  std::vector<fs::path> files;
  bool json = false;
};

double slip_m(const SubmapPair& pair) { return pair.slip.mean.translation().norm(); }
double slip_deg(const SubmapPair& pair) { return rotation_angle(pair.slip.mean) * 180 / std::numbers::pi; }

using Maps = std::vector<std::unique_ptr<mapping::SemanticOcTree>>;

/// Errors: those of reading; kUnsupported for another resolution than the first map's.
Result<Maps> load(const std::vector<fs::path>& files) {
  Maps maps;
  for (const fs::path& file : files) {
    auto map = mapping::load_map(file);
    if (!map) return at(file.string(), map.error());
    maps.push_back(*std::move(map));
    const double first = maps.front()->getResolution(), here = maps.back()->getResolution();
    if (here != first)
      return Error{Errc::kUnsupported,
                   "submaps of one map have one resolution",
                   file.string(),
                   {},
                   fmt::format("these have {} m and {} m", first, here)};
  }
  return maps;
}

/// Errors: those of MapFeatures::build().
Result<std::vector<SubmapPair>> check(const std::vector<fs::path>& files, const Maps& maps) {
  std::vector<MapFeatures> features;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    auto made = MapFeatures::build(*maps[i]);
    if (!made) return at(files[i].string(), made.error());
    features.push_back(*std::move(made));
  }
  std::vector<const MapFeatures*> submaps;
  for (const MapFeatures& f : features) submaps.push_back(&f);
  Budget budget = Budget::steps(matching::kAmpleSteps);
  return matching::check_submaps(submaps, budget);
}

report::Json to_json(const SubmapPair& pair, const MapCheckOptions& options) {
  const Vector6 slip = pair.slip.mean.xyz_rpy();
  return {{"first", options.files.at(pair.first).string()},
          {"second", options.files.at(pair.second).string()},
          {"consistent", pair.consistent},
          {"reason", pair.reason},
          {"slip_m", slip_m(pair)},
          {"slip_deg", slip_deg(pair)},
          {"slip", std::vector<double>(slip.begin(), slip.end())},
          {"chi2", pair.chi2},
          {"conflict", pair.conflict}};
}

int told_as_json(const MapCheckOptions& options, const std::vector<SubmapPair>& pairs, std::ptrdiff_t contradictions) {
  report::Json json{{"submaps", options.files.size()},
                    {"compared", pairs.size()},
                    {"contradictions", contradictions},
                    {"consistent", contradictions == 0},
                    {"pairs", report::Json::array()}};
  for (const SubmapPair& pair : pairs) json["pairs"].push_back(to_json(pair, options));
  return app::print(json);
}

int run(const MapCheckOptions& options) {
  const auto maps = load(options.files);
  if (!maps) return app::fail(maps.error());
  const auto checked = app::while_working("comparing submaps", [&] { return check(options.files, *maps); });
  if (!checked) return app::fail(checked.error());
  const std::vector<SubmapPair>& pairs = *checked;
  const auto contradictions = std::count_if(pairs.begin(), pairs.end(), [](const auto& p) { return !p.consistent; });
  if (options.json) return told_as_json(options, pairs, contradictions);
  for (const SubmapPair& pair : pairs)
    if (!pair.consistent)
      std::cout << fmt::format("{} contradicts {}: {} (slip {:.3f} m, {:.2f} deg; chi2 {:.1f}; conflict {:.3f})\n",
                               options.files.at(pair.second).string(), options.files.at(pair.first).string(),
                               pair.reason, slip_m(pair), slip_deg(pair), pair.chi2, pair.conflict);
  std::cout << fmt::format("{}: {} submaps, {} pairs with enough in common, {} of them contradict\n",
                           pairs.empty()         ? "nothing to compare"
                           : contradictions == 0 ? "consistent"
                                                 : "inconsistent",
                           options.files.size(), pairs.size(), contradictions);
  return app::kDone;
}

}  // namespace

void add_map_check_command(app::Commands& commands, CLI::App& map) {
  CLI::App* sub =
      map.add_subcommand("check", "says which submaps of one robot contradict each other; all in one frame");
  const auto options = std::make_shared<MapCheckOptions>();
  sub->add_option("files", options->files,
                  "two or more maps (.cairn, .ot or .bt), in the order in which they were made")
      ->required()
      ->expected(2, -1);
  sub->add_flag("--json", options->json, "one JSON object on stdout");
  sub->callback([&commands, options] { commands.job = [options] { return run(*options); }; });
}

}  // namespace cairn::cli
