// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/merge_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fusion/merging/merge.hpp"
#include "fusion/merging/positions_file.hpp"
#include "fusion/merging/voxel_positions.hpp"
#include "hal/clock.hpp"
#include "hal/files/unfinished_folder.hpp"
#include "onboard/app/cli/working_line.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/map/pose_option.hpp"
#include "tools/cli/map/save_map.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kReach_voxels = 32768;  // OctoMap's keys have 16 bits

struct MergeMapsOptions {
  fs::path a, b, out;
  std::vector<double> pose;        // x y z roll pitch yaw of b in a
  std::vector<double> covariance;  // row by row; empty: the pose is exact
  fs::path positions;              // file; empty: not asked for
  std::string policy{merging::policy_names().front()};

  [[nodiscard]] bool wants_positions() const { return !positions.empty() || !covariance.empty(); }
  bool json = false;
};

/// The same map in the same place is one contribution: what was seen once must not count twice.
merging::Contributions contributions(std::shared_ptr<const mapping::SemanticOcTree> a,
                                     std::shared_ptr<const mapping::SemanticOcTree> b, const SE3& T_a_b) {
  const bool same =
      T_a_b.matrix() == Eigen::Matrix4d::Identity() && mapping::encode_cairn(*a) == mapping::encode_cairn(*b);
  merging::Contributions all;
  all[1] = {1, std::move(a), {}};
  if (!same) all[2] = {1, std::move(b), T_a_b};
  return all;
}

/// Where the fused voxels are. Writes the file, if one is asked for.
Result<std::optional<mapping::PositionFigures>> positions(const MergeMapsOptions& options,
                                                          const mapping::SemanticOcTree& fused,
                                                          const merging::Contributions& all,
                                                          const Matrix6& covariance) {
  if (!options.wants_positions()) return std::optional<mapping::PositionFigures>();
  std::vector<merging::PlacedMap> maps;
  for (const auto& [robot, contribution] : all)
    maps.push_back({contribution.map.get(), {contribution.T_fused_map, robot == 1 ? Matrix6::Zero() : covariance}});
  const auto found = merging::voxel_positions(fused, maps);
  if (!found) return found.error();
  if (!options.positions.empty())
    if (const auto saved = merging::save_positions(*found, options.positions); !saved) return saved.error();
  return std::optional(merging::position_figures(*found));
}

int report(const MergeMapsOptions& options, const mapping::SemanticOcTree& fused, double seconds,
           const std::optional<mapping::PositionFigures>& places) {
  const report::MapSummary summary = report::summarise(fused);
  if (options.json) {
    report::Json json{{"out", options.out.string()}, {"policy", options.policy}, {"seconds", seconds}};
    json.update(report::to_json(summary));
    if (places) json["positions"] = report::to_json(*places);
    return app::print(json);
  }
  std::cout << fmt::format("{}: {} voxels occupied, {} free\n", options.out.string(), summary.occupied, summary.free);
  if (summary.mean_entropy_occupancy)
    std::cout << fmt::format("mean entropy {:.4f} bit over occupied voxels\n", *summary.mean_entropy_occupancy);
  if (places)
    std::cout << fmt::format(
        "a voxel is known to {:.3f} m on average, 95 % to {:.3f} m; the {} that both maps know to {:.3f} m, by one map "
        "alone to {:.3f} m\n",
        places->mean_m, places->p95_m, places->shared, places->shared_mean_m, places->shared_alone_m);
  return app::kDone;
}

/// A map that reaches out of the octree around the first one would lose voxels without a word.
Result<void> check_reach(const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b, const SE3& T_a_b) {
  const report::MapSummary of_b = report::summarise(b);
  if (of_b.occupied + of_b.free == 0) return {};
  const double reach_m = kReach_voxels * std::min(a.getResolution(), b.getResolution());
  double farthest_m = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto end = [&](int axis) { return (corner >> axis & 1) != 0 ? of_b.max_m[axis] : of_b.min_m[axis]; };
    farthest_m = std::max(farthest_m, (T_a_b * Eigen::Vector3d(end(0), end(1), end(2))).cwiseAbs().maxCoeff());
  }
  if (farthest_m <= reach_m) return {};
  return Error{Errc::kInvalidConfig,
               "the second map would lie outside of what a map can hold",
               "--pose",
               {},
               fmt::format("it reaches to {:.6g} m, and voxels of this size to {:.6g} m", farthest_m, reach_m)};
}

int run(const MergeMapsOptions& options) {
  if (const auto named = check_map_name(options.out); !named) return app::fail(named.error());
  const auto T_a_b = pose_from_option("--pose", options.pose);
  if (!T_a_b) return app::fail(T_a_b.error());
  const auto covariance = covariance_from_option("--covariance", options.covariance);
  if (!covariance) return app::fail(covariance.error());
  if (!options.positions.empty() && options.positions.extension() != ".ply")
    return app::fail({Errc::kInvalidConfig, "the name must end in .ply", "--positions " + options.positions.string()});
  if (options.positions == options.out)
    return app::fail({Errc::kInvalidConfig, "is the same file as --out", "--positions " + options.positions.string()});
  for (const auto& input : {options.a, options.b})
    if (const auto kept = keep_input(input, options.out); !kept) return app::fail(kept.error());
  auto a = mapping::load_map(options.a), b = mapping::load_map(options.b);
  if (!a) return app::fail(at(options.a.string(), a.error()));
  if (!b) return app::fail(at(options.b.string(), b.error()));
  if (const auto fits = check_reach(**a, **b, *T_a_b); !fits) return app::fail(fits.error());
  const auto all = contributions(std::move(*a), std::move(*b), *T_a_b);
  Duration took{};  // CPU time
  const auto fused = app::while_working("merging", [&] {
    const Duration start = thread_cpu_time();
    auto merged = merging::merge(all, {.policy = *merging::policy_from(options.policy)});
    took = thread_cpu_time() - start;
    return merged;
  });
  if (!fused) return app::fail(fused.error());
  if (const auto saved = save_map(**fused, options.out); !saved) return app::fail(saved.error());
  const auto places = positions(options, **fused, all, *covariance);
  if (!places) return app::fail(places.error());
  return report(options, **fused, to_seconds(took), *places);
}

}  // namespace

void add_merge_command(app::Commands& commands) {
  CLI::App* sub = commands.app.add_subcommand("merge", "fuses two maps into one");
  const auto options = std::make_shared<MergeMapsOptions>();
  const auto names = merging::policy_names();
  sub->add_option("a", options->a, "first map (.cairn, .ot or .bt); the result is in its frame")->required();
  sub->add_option("b", options->b, "second map")->required();
  sub->add_option("--pose", options->pose, "x,y,z,roll,pitch,yaw of b in a, m and rad, as cairn match finds it")
      ->delimiter(',')
      ->expected(6)
      ->required();
  sub->add_option("--covariance", options->covariance,
                  "of the pose, as cairn match --json prints it: 36 numbers, m and rad; default: the pose is exact")
      ->delimiter(',')
      ->expected(36);
  sub->add_option("--positions", options->positions,
                  "file to write, .ply: where each occupied voxel is, and how well that is known");
  sub->add_option("--policy", options->policy, "rule for voxels that both maps know")
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())))
      ->capture_default_str();
  sub->add_option("--out", options->out, "file to write: .cairn, .ot, .bt, .ply or .pcd")->required();
  sub->add_flag("--json", options->json, "one JSON object on stdout");
  sub->callback([&commands, options] { commands.job = [options] { return run(*options); }; });
}

}  // namespace cairn::cli
