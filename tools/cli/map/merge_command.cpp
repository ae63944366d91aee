// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/merge_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "fusion/merging/merge.hpp"
#include "hal/clock.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/map_measures.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/map/save_map.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path a, b, out;
  std::vector<double> pose;  // x y z roll pitch yaw of b in a
  std::string policy{merging::policy_names().front()};
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

int report(const Options& options, const mapping::SemanticOcTree& fused, double seconds) {
  const report::MapSummary summary = report::summarise(fused);
  if (options.json) {
    report::Json json{{"out", options.out.string()}, {"policy", options.policy}, {"seconds", seconds}};
    json.update(report::to_json(summary));
    return app::print(json);
  }
  std::cout << fmt::format("{}: {} voxels occupied, {} free\n", options.out.string(), summary.occupied, summary.free);
  if (summary.mean_entropy_occupancy)
    std::cout << fmt::format("mean entropy {:.4f} bit over occupied voxels\n", *summary.mean_entropy_occupancy);
  return app::kDone;
}

int run(const Options& options) {
  if (const auto named = check_map_name(options.out); !named) return app::fail(named.error());
  auto a = mapping::load_map(options.a), b = mapping::load_map(options.b);
  if (!a) return app::fail(at(options.a.string(), a.error()));
  if (!b) return app::fail(at(options.b.string(), b.error()));
  const SE3 T_a_b = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(options.pose.data()));
  const auto all = contributions(std::move(*a), std::move(*b), T_a_b);
  const Duration start = thread_cpu_time();
  const auto fused = merging::merge(all, {.policy = *merging::policy_from(options.policy)});
  const double seconds = to_seconds(thread_cpu_time() - start);
  if (!fused) return app::fail(fused.error());
  if (const auto saved = save_map(**fused, options.out); !saved) return app::fail(saved.error());
  return report(options, **fused, seconds);
}

}  // namespace

void add_merge_command(app::Commands& commands) {
  CLI::App* sub = commands.app.add_subcommand("merge", "fuses two maps into one");
  const auto options = std::make_shared<Options>();
  const auto names = merging::policy_names();
  sub->add_option("a", options->a, "first map (.cairn, .ot or .bt); the result is in its frame")->required();
  sub->add_option("b", options->b, "second map")->required();
  sub->add_option("--pose", options->pose, "x,y,z,roll,pitch,yaw of b in a, m and rad, as cairn match finds it")
      ->delimiter(',')
      ->expected(6)
      ->required();
  sub->add_option("--policy", options->policy, "rule for voxels that both maps know")
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())))
      ->capture_default_str();
  sub->add_option("--out", options->out, "file to write: .cairn, .ot, .bt, .ply or .pcd")->required();
  sub->add_flag("--json", options->json, "one JSON object on stdout");
  sub->callback([&commands, options] { commands.job = [options] { return run(*options); }; });
}

}  // namespace cairn::cli
