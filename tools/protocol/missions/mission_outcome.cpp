// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/missions/mission_outcome.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/map_error.hpp"
#include "tools/protocol/pairs/merged_pair.hpp"
#include "tools/protocol/report/figures.hpp"

namespace cairn::protocol {
namespace {

namespace fs = std::filesystem;

Result<MergedFigures> merged_figures(const MapPair& pair, const Mission& mission, const mapping::SemanticOcTree& world,
                                     const SE3& T_a_b, merging::Policy policy) {
  const auto merged = merged_pair(pair, T_a_b, policy);
  if (!merged) return merged.error();
  const auto error = report::map_error(**merged, world, {mission.T_world_a, MergedFigures::kGhostM, 1});
  if (!error) return error.error();
  return MergedFigures{error->occupied, error->occupied - error->correct, error->rmse_m};
}

Result<std::optional<MethodRun>> run_of(const fs::path& dir, std::string_view method) {
  const fs::path file = dir / (method == "icp" ? "pcl.json" : "ours.json");
  if (!fs::exists(file)) return std::nullopt;
  auto runs = load_runs(file);
  if (!runs) return runs.error();
  for (MethodRun& run : *runs)
    if (run.method == method) return std::move(run);
  return std::nullopt;
}

Result<MissionOutcome> load(const fs::path& pairs, MissionOutcome outcome, const mapping::SemanticOcTree& world) {
  const fs::path dir = pairs / name_of(outcome.mission);
  auto mission = load_mission(dir / "mission.json");
  if (!mission) return mission.error();
  outcome.mission = *std::move(mission);
  const Approach& approach = kApproaches.at(outcome.approach);
  auto run = run_of(dir, approach.method);
  if (!run) return run.error();
  outcome.run = *std::move(run);
  if (!outcome.run) return outcome;
  const auto exact = std::ranges::find(outcome.run->attempts, kExactStart, &Attempt::start);
  if (exact == outcome.run->attempts.end()) return outcome;
  const auto pair = load_pair(dir);
  if (!pair) return pair.error();
  auto merged = merged_figures(*pair, outcome.mission, world, exact->T_a_b, approach.policy);
  if (!merged) return merged.error();
  outcome.merged = *merged;
  return outcome;
}

/// All phases and approaches by one light, in one world.
Result<void> load_light(const fs::path& pairs, const char* light, std::vector<MissionOutcome>& all) {
  MissionOutcome blank{
      .mission = {.light = light, .pipeline = kNobody, .phase = kPhases[0], .T_world_a = {}, .world = {}},
      .run = {},
      .merged = {}};
  const auto first = load_mission(pairs / name_of(blank.mission) / "mission.json");
  if (!first) return first.error();
  auto world = mapping::load_map(first->world);
  if (!world) return at(first->world.string(), world.error());
  for (const char* phase : kPhases)
    for (blank.approach = 0; blank.approach < kApproaches.size(); ++blank.approach) {
      blank.mission.phase = phase;
      blank.mission.pipeline = kApproaches.at(blank.approach).pipeline;
      auto outcome = load(pairs, blank, **world);
      if (!outcome) return outcome.error();
      all.push_back(*std::move(outcome));
    }
  return {};
}

}  // namespace

double MissionOutcome::rms_m() const { return run ? figures_of(run->attempts).rms_m : 0; }

double MissionOutcome::success() const { return run ? figures_of(run->attempts).success : 0; }

Result<std::vector<MissionOutcome>> load_missions(const fs::path& pairs) {
  std::vector<MissionOutcome> all;
  for (const char* light : kLights)
    if (auto loaded = load_light(pairs, light, all); !loaded) return loaded.error();
  return all;
}

const MissionOutcome* find(const std::vector<MissionOutcome>& all, std::string_view light, std::string_view phase,
                           std::size_t approach) {
  const auto found = std::ranges::find_if(all, [&](const MissionOutcome& o) {
    return o.mission.light == light && o.mission.phase == phase && o.approach == approach;
  });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace cairn::protocol
