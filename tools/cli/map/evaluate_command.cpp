// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/evaluate_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "onboard/app/cli/working_line.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/mapping/files/map_file.hpp"
#include "onboard/report/figures/map_error.hpp"
#include "onboard/report/figures/trajectory_error.hpp"
#include "onboard/report/json/report_json.hpp"
#include "onboard/report/labels/label_measures.hpp"
#include "tools/cli/evaluate/detectors_command.hpp"
#include "tools/cli/evaluate/mover_error.hpp"
#include "tools/cli/evaluate/path.hpp"
#include "tools/cli/evaluate/people_command.hpp"
#include "tools/cli/evaluate/true_scans.hpp"
#include "tools/cli/map/pose_option.hpp"
#include "tools/cli/projection/projection_command.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

struct EvaluateOptions {
  fs::path estimate, truth;
  std::string align;
  double max_gap_s = to_seconds(report::TrajectoryErrorOptions{}.max_gap);
  std::vector<double> pose;  // x y z roll pitch yaw of the map in the true map's frame
  fs::path trajectory, true_trajectory;
  double tolerance_m = 0;
  fs::path recording;  // that says which returns are people
  bool json = false;
};

/// A folder stands for the file of that name in it.
fs::path file_in(const fs::path& path, const char* name) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) ? path / name : path;
}

Result<std::vector<recording::StampedPose>> read_poses(const fs::path& path, const char* name) {
  const fs::path file = file_in(path, name);
  auto poses = recording::read_tum(file);
  if (!poses) return at(file.string(), poses.error());
  return poses;
}

int evaluate_trajectory(const EvaluateOptions& options) {
  const auto estimate = read_poses(options.estimate, "trajectory.tum");
  if (!estimate) return app::fail(estimate.error());
  const auto truth = read_poses(options.truth, "ground_truth.tum");
  if (!truth) return app::fail(truth.error());
  const report::Alignment alignment = report::alignment_from(options.align).value_or(report::Alignment::kSe3);
  const auto error = report::trajectory_error(*estimate, *truth, {alignment, from_seconds(options.max_gap_s)});
  if (!error) return app::fail(at(options.estimate.string(), error.error()));
  if (options.json) {
    report::Json json = report::to_json(*error);
    json["align"] = options.align;
    return app::print(json);
  }
  const auto& e = *error;
  std::cout << fmt::format("{} poses over {:.2f} m and {:.2f} s ({} without ground truth)\n", e.matched, e.length_m,
                           e.duration_s, e.unmatched);
  std::cout << fmt::format("ATE           {:.4f} m RMS, {:.4f} m at most (aligned: {})\n", e.ate_rmse_m, e.ate_max_m,
                           options.align);
  std::cout << fmt::format("              {:.4f} m first poses aligned, {:.4f} m least squares\n", e.ate_first_rmse_m,
                           e.ate_se3_rmse_m);
  std::cout << fmt::format("at the end    {:.4f} m", e.final_error_m);
  if (e.final_error_percent) std::cout << fmt::format(", {:.3f} % of the length", *e.final_error_percent);
  std::cout << '\n';
  if (e.segments)
    std::cout << fmt::format("per segment   {:.3f} %, {:.5f} °/m over {} segments\n", e.segments->trans_percent,
                             e.segments->rot_deg_per_m, e.segments->segments);
  if (e.steps)
    std::cout << fmt::format("pose to pose  {:.3f} %, {:.5f} °/m\n", e.steps->trans_percent, e.steps->rot_deg_per_m);
  return app::kDone;
}

/// Where the map's frame lies in the true map's: as given, or by the first common pose of two trajectories.
Result<SE3> T_truth_map(const EvaluateOptions& options) {
  if (!options.pose.empty()) return pose_from_option("--pose", options.pose);
  if (options.trajectory.empty()) return SE3();
  const auto estimate = read_poses(options.trajectory, "trajectory.tum");
  if (!estimate) return estimate.error();
  const auto truth = read_poses(options.true_trajectory, "ground_truth.tum");
  if (!truth) return truth.error();
  const auto matched = report::match_by_time(*estimate, *truth, from_seconds(options.max_gap_s));
  if (matched.empty())
    return Error{Errc::kMalformed, "both trajectories have no common time", options.trajectory.string(), {}, {}};
  return report::align(matched, report::alignment_from(options.align).value_or(report::Alignment::kFirst));
}

report::Json to_json(const MoverError& e) {
  const auto share = [](std::optional<double> value) { return value ? report::Json(*value) : report::Json(nullptr); };
  return {{"static_accuracy", share(e.static_accuracy())},
          {"dynamic_accuracy", share(e.dynamic_accuracy())},
          {"seen_static_accuracy", share(e.seen_static_accuracy())},
          {"static_voxels", e.static_voxels},
          {"seen_static_voxels", e.seen_static_voxels},
          {"movers_voxels", e.mover_voxels}};
}

/// What to try where hardly a voxel is right; empty: nothing.
std::string hint(const EvaluateOptions& options, const report::MapError& error) {
  constexpr double kHardly = 0.5;
  if (error.precision().value_or(1) >= kHardly) return {};
  if (!options.pose.empty() || !options.trajectory.empty())
    return "few voxels are right: check that the given pose is that of the map in the true map's frame";
  return "the frames of both maps seem not to be aligned: give --trajectory RUN --ground-truth-trajectory RECORDING, "
         "or --pose";
}

/// Empty where nothing can be said: the true map or the map has no labels.
std::string in_words(const report::LabelError& e) {
  const auto accuracy = e.confusion.agreement(), miou = e.confusion.miou(report::kMinTrueVoxels);
  if (!accuracy) return {};
  std::string text = fmt::format("labels     {:.4f} right of {} voxels, {:.4f} of the common ones are labelled\n",
                                 *accuracy, e.labelled, e.labelled_share().value_or(0));
  if (miou)
    text += fmt::format("mean IoU   {:.4f} of classes with {} true voxels or more\n", *miou, report::kMinTrueVoxels);
  for (std::size_t i = 0; i < report::kClasses; ++i)
    if (const auto iou = e.confusion.iou(i); iou && e.confusion.voxels_of(i) > 0)
      text += fmt::format("  {:<13} {:.4f}, {} voxels\n", kSemanticClasses[i].name, *iou, e.confusion.voxels_of(i));
  return text;
}

/// The path that the map was made with, in the map's frame: the run's where it is given, else the true one.
Result<Path> path_of_map(const EvaluateOptions& options, const Path& truth, const SE3& T_world_map) {
  if (options.trajectory.empty()) return truth.moved(T_world_map.inverse());
  return Path::read(file_in(options.trajectory, "trajectory.tum"));
}

Result<MoverError> compare_movers(const EvaluateOptions& options, const app::RobotProfile& profile, const Path& truth,
                                  const Path& path, const mapping::SemanticOcTree& map, MoverTruth& movers) {
  constexpr Duration kSameScan = std::chrono::milliseconds(20);
  auto done = for_each_true_scan(options.recording, profile, truth, [&](const TrueScan& scan) { movers.count(scan); });
  if (!done) return done.error();
  Result<void> inserted;
  done = for_each_true_scan(options.recording, profile, path, [&](const TrueScan& scan) {
    if (inserted && path.has_pose_near(scan.stamp, kSameScan)) inserted = movers.insert(scan);
  });
  if (!done) return done.error();
  if (!inserted) return at(options.recording.string(), inserted.error());
  return movers.judge(map);
}

/// How the map treats people who walk about; none where no recording says who they are.
Result<std::optional<MoverError>> mover_error(const EvaluateOptions& options, const mapping::SemanticOcTree& map,
                                              const mapping::SemanticOcTree& truth, const SE3& T_world_map) {
  if (options.recording.empty()) return std::optional<MoverError>();
  const auto chosen = app::choose_profile({}, options.recording);
  if (!chosen) return chosen.error();
  const auto true_path = Path::read(options.recording / "ground_truth.tum");
  if (!true_path) return true_path.error();
  const auto path = path_of_map(options, *true_path, T_world_map);
  if (!path) return path.error();
  mapping::MappingConfig config = chosen->profile.mapping;
  config.resolution_m = map.getResolution();
  MoverTruth movers(truth, T_world_map, config);
  const auto error = app::while_working("placing the recording's returns in the world", [&] {
    return compare_movers(options, chosen->profile, *true_path, *path, map, movers);
  });
  if (!error) return error.error();
  return std::optional(*error);
}

void print(const MoverError& e) {
  if (const auto share = e.static_accuracy())
    std::cout << fmt::format("static     {:.4f} kept of {} voxels that a map without people has\n", *share,
                             e.static_voxels);
  if (const auto share = e.dynamic_accuracy())
    std::cout << fmt::format("dynamic    {:.4f} free of {} voxels that people walked through\n", *share,
                             e.mover_voxels);
}

int say(const EvaluateOptions& options, const report::MapError& e, const report::LabelError& labels,
        const std::optional<MoverError>& movers) {
  const std::string tip = hint(options, e);
  if (options.json) {
    report::Json json = report::to_json(e);
    json.update(report::to_json(labels));
    if (movers) json.update(to_json(*movers));
    json["hint"] = tip.empty() ? report::Json(nullptr) : report::Json(tip);
    return app::print(json);
  }
  std::cout << fmt::format("accuracy   {:.4f} m mean, {:.4f} m RMS from {} occupied voxels to the true ones\n",
                           e.mean_m, e.rmse_m, e.occupied);
  if (const auto p = e.precision()) std::cout << fmt::format("precision  {:.4f}\n", *p);
  if (const auto r = e.recall()) std::cout << fmt::format("recall     {:.4f} of what was seen\n", *r);
  std::cout << fmt::format("true map   {} occupied voxels: {} found, {} called free, {} never seen\n", e.true_occupied,
                           e.found, e.contradicted, e.unseen);
  std::cout << in_words(labels);
  if (movers) print(*movers);
  if (!tip.empty()) std::cout << "hint       " << tip << '\n';
  return app::kDone;
}

int evaluate_map(const EvaluateOptions& options) {
  const fs::path file = file_in(options.estimate, "map.cairn"), true_file = file_in(options.truth, "world.ot");
  const auto map = mapping::load_map(file), truth = mapping::load_map(true_file);
  if (!map) return app::fail(at(file.string(), map.error()));
  if (!truth) return app::fail(at(true_file.string(), truth.error()));
  if (const auto few = mapping::listable_voxels(**map); !few) return app::fail(at(file.string(), few.error()));
  if (const auto few = mapping::listable_voxels(**truth); !few) return app::fail(at(true_file.string(), few.error()));
  const auto T = T_truth_map(options);
  if (!T) return app::fail(T.error());
  const auto error = app::while_working("comparing with the true map", [&] {
    return report::map_error(**map, **truth, {*T, options.tolerance_m});
  });
  if (!error) return app::fail(at(file.string(), error.error()));
  const auto labels = report::label_error(**map, **truth, *T);
  if (!labels) return app::fail(at(file.string(), labels.error()));
  const auto movers = mover_error(options, **map, **truth, *T);
  if (!movers) return app::fail(movers.error());
  return say(options, *error, *labels, *movers);
}

void add(app::Commands& commands, CLI::App* sub, const std::shared_ptr<EvaluateOptions>& options,
         int (*job)(const EvaluateOptions&)) {
  sub->add_flag("--json", options->json, "one JSON object on stdout");
  sub->callback([&commands, options, job] { commands.job = [options, job] { return job(*options); }; });
}

void add_trajectory(app::Commands& commands, CLI::App& evaluate, const std::shared_ptr<EvaluateOptions>& options) {
  CLI::App* sub = evaluate.add_subcommand("trajectory", "compares a trajectory with the true one");
  options->align = "se3";
  sub->add_option("estimate", options->estimate, "TUM file, or the folder of a run")->required();
  sub->add_option("--ground-truth", options->truth, "TUM file, or the folder of a recording")->required();
  sub->add_option(
         "--align", options->align,
         "how the two are aligned for absolute errors: first (first poses), se3 (least squares, as evo -a), none")
      ->check(CLI::IsMember({"first", "se3", "none"}))
      ->capture_default_str();
  sub->add_option("--max-gap", options->max_gap_s, "longest gap that the ground truth is interpolated over, s")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  add(commands, sub, options, evaluate_trajectory);
}

void add_map(app::Commands& commands, CLI::App& evaluate, const std::shared_ptr<EvaluateOptions>& options) {
  CLI::App* sub = evaluate.add_subcommand("map", "compares the occupied voxels of a map with the true ones");
  options->align = "first";
  sub->footer(
      "A label is right if an occupied true voxel that the voxel overlaps has the same class: their centres are at "
      "most label_tolerance_m apart along each axis, about one voxel.");
  sub->add_option("estimate", options->estimate, "map, or the folder of a run")->required();
  sub->add_option("--ground-truth", options->truth, "true map, or the folder of a recording")->required();
  CLI::Option* pose =
      sub->add_option("--pose", options->pose, "x,y,z,roll,pitch,yaw of the map in the true map, m and rad")
          ->delimiter(',')
          ->expected(6);
  CLI::Option* from =
      sub->add_option("--trajectory", options->trajectory, "the run's trajectory; it and the true one give the pose")
          ->excludes(pose);
  CLI::Option* to = sub->add_option("--ground-truth-trajectory", options->true_trajectory, "the true trajectory");
  sub->add_option("--align", options->align,
                  "how the trajectories give the pose: first (their first poses coincide), se3 (least squares)")
      ->check(CLI::IsMember({"first", "se3"}))
      ->capture_default_str()
      ->needs(from);
  from->needs(to);
  to->needs(from);
  sub->add_option("--tolerance", options->tolerance_m,
                  "distance up to which a voxel counts as correct, m; default: a voxel's diagonal")
      ->check(app::above_zero);
  sub->add_option("--recording", options->recording,
                  "simulated recording with people: adds static accuracy (standing voxels kept) and dynamic accuracy "
                  "(walked places left free); --ground-truth is then the true map without people")
      ->check(CLI::ExistingDirectory);
  add(commands, sub, options, evaluate_map);
}

}  // namespace

void add_evaluate_command(app::Commands& commands) {
  CLI::App& evaluate = *commands.app.add_subcommand("evaluate", "errors against ground truth, and of a calibration");
  evaluate.require_subcommand(1);
  add_trajectory(commands, evaluate, std::make_shared<EvaluateOptions>());
  add_map(commands, evaluate, std::make_shared<EvaluateOptions>());
  add_evaluate_people_command(commands, evaluate);
  add_evaluate_detectors_command(commands, evaluate);
  add_projection_command(commands, evaluate);
}

}  // namespace cairn::cli
