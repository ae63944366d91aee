// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/match_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "fusion/matching/book/methods.hpp"
#include "hal/clock.hpp"
#include "onboard/app/cli/working_line.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/map/pose_option.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;
using matching::MapFeatures;
using matching::MatchResult;

constexpr double kDegree = std::numbers::pi / 180;

struct MatchMapsOptions {
  fs::path a, b;
  std::string method{matching::all_method_names().front()};
  std::vector<double> initial;  // x y z roll pitch yaw
  double sigma_m = 0.8, sigma_deg = 6;
  int max_steps = matching::kAmpleSteps;
  bool json = false;
};

Result<std::optional<UncertainPose>> guess(const MatchMapsOptions& options) {
  if (options.initial.empty()) return std::optional<UncertainPose>();
  const auto initial = pose_from_option("--initial", options.initial);
  if (!initial) return initial.error();
  UncertainPose pose{*initial, matching::default_prior_covariance()};
  pose.covariance(0, 0) = pose.covariance(1, 1) = options.sigma_m * options.sigma_m;
  pose.covariance(5, 5) = options.sigma_deg * options.sigma_deg * kDegree * kDegree;
  return std::optional(pose);
}

Result<MatchResult> match(const MatchMapsOptions& options, const std::optional<UncertainPose>& initial,
                          const mapping::SemanticOcTree& a, const mapping::SemanticOcTree& b) {
  const auto features_a = MapFeatures::build(a);
  if (!features_a) return at(options.a.string(), features_a.error());
  const auto features_b = MapFeatures::build(b);
  if (!features_b) return at(options.b.string(), features_b.error());
  const auto matcher = matching::make_any_matcher(options.method, *features_a, *features_b);
  if (!matcher) return matcher.error();
  Budget budget = Budget::steps(options.max_steps);
  return (*matcher)->match(initial, budget);
}

template <class Matrix>
report::Json row_major(const Matrix& m) {
  report::Json values = report::Json::array();
  for (int row = 0; row < m.rows(); ++row)
    for (int column = 0; column < m.cols(); ++column) values.push_back(m(row, column));
  return values;
}

report::Json to_json(const MatchResult& r, double seconds) {
  const auto& e = r.evidence;
  return {{"T_a_b", row_major(r.T_a_b.mean.matrix())},
          {"covariance", row_major(r.T_a_b.covariance)},
          {"overlap", r.overlap},
          {"inlier_ratio", r.inlier_ratio},
          {"threshold", r.threshold},
          {"accepted", r.accepted},
          {"probability_correct", r.probability_correct},
          {"reason", r.reason},
          {"iterations", r.iterations},
          {"seconds", seconds},
          {"book_accepted", r.book_accepted},
          {"structure_inliers", e.structure_inliers},
          {"structure_pairs", e.structure_pairs},
          {"agreeing_m2", e.agreeing_m2},
          {"agreeing_floor_m2", e.agreeing_floor_m2},
          {"conflict", e.conflict},
          {"reverse_conflict", e.reverse_conflict},
          {"weakest_translation", e.weakest_translation},
          {"uniqueness", e.uniqueness}};
}

std::string to_text(const MatchResult& r) {
  const Vector6 v = r.T_a_b.mean.xyz_rpy();
  const Vector6 sigma = r.T_a_b.covariance.diagonal().cwiseSqrt();
  return fmt::format(
      "b in a     x {:.3f} y {:.3f} z {:.3f} m, roll {:.3f} pitch {:.3f} yaw {:.3f} deg\n"
      "in rad     --pose={:.4f},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f}\n"
      "±1σ        {:.3f} {:.3f} {:.3f} m, {:.3f} {:.3f} {:.3f} deg\n"
      "{}   probability {:.3f}: {}\n"
      "overlap    {:.2f}, inliers {:.2f} (the book asks for {:.2f})\n",
      v[0], v[1], v[2], v[3] / kDegree, v[4] / kDegree, v[5] / kDegree, v[0], v[1], v[2], v[3], v[4], v[5], sigma[0],
      sigma[1], sigma[2], sigma[3] / kDegree, sigma[4] / kDegree, sigma[5] / kDegree,
      r.accepted ? "accepted" : "refused ", r.probability_correct, r.reason, r.overlap, r.inlier_ratio, r.threshold);
}

int run(const MatchMapsOptions& options) {
  const auto initial = guess(options);
  if (!initial) return app::fail(initial.error());
  const auto a = mapping::load_map(options.a), b = mapping::load_map(options.b);
  if (!a) return app::fail(at(options.a.string(), a.error()));
  if (!b) return app::fail(at(options.b.string(), b.error()));
  Duration took{};  // CPU time
  const auto result = app::while_working("matching with " + options.method, [&] {
    const Duration start = thread_cpu_time();
    auto matched = match(options, *initial, **a, **b);
    took = thread_cpu_time() - start;
    return matched;
  });
  if (!result) return app::fail(result.error());
  if (options.json)
    app::print(to_json(*result, to_seconds(took)));
  else
    std::cout << to_text(*result);
  return result->accepted ? app::kDone : app::kFailed;
}

}  // namespace

void add_match_command(app::Commands& commands) {
  CLI::App* sub = commands.app.add_subcommand(
      "match", "finds the relative pose of two maps; exits with 1 where it refuses the pose");
  const auto options = std::make_shared<MatchMapsOptions>();
  sub->add_option("a", options->a, "first map (.cairn, .ot or .bt); the pose is in its frame")->required();
  sub->add_option("b", options->b, "second map, whose pose is sought")->required();
  sub->add_option("--method", options->method, "method; global_6dof allows maps whose z does not point up")
      ->check(CLI::IsMember(
          std::vector<std::string>(matching::all_method_names().begin(), matching::all_method_names().end())))
      ->capture_default_str();
  CLI::Option* initial = sub->add_option("--initial", options->initial,
                                         "guess: x,y,z,roll,pitch,yaw of b in a, m and rad; without it all headings "
                                         "and distances are searched, with z upwards in both maps")
                             ->delimiter(',')
                             ->expected(6);
  sub->add_option("--sigma", options->sigma_m, "standard deviation of the guess in x and y, m; 3 σ are searched")
      ->check(CLI::Range(0.01, 7.0))
      ->needs(initial)
      ->capture_default_str();
  sub->add_option("--sigma-deg", options->sigma_deg, "standard deviation of the guess in heading, degrees")
      ->check(CLI::Range(0.1, 180.0))
      ->needs(initial)
      ->capture_default_str();
  sub->add_option("--max-steps", options->max_steps, "number of steps after which the search ends with its best result")
      ->check(CLI::Range(1, matching::kAmpleSteps))
      ->capture_default_str();
  sub->add_flag("--json", options->json, "one JSON object on stdout");
  sub->callback([&commands, options] { commands.job = [options] { return run(*options); }; });
}

}  // namespace cairn::cli
