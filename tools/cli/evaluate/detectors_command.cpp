// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/detectors_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "onboard/app/cli/working_line.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/evaluate/answer_file.hpp"
#include "tools/cli/evaluate/detector_fit.hpp"
#include "tools/cli/evaluate/people_file.hpp"
#include "tools/cli/evaluate/people_scene.hpp"

namespace cairn::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kAtSomebody_m = 0.5, kAtNobody_m = 1.0;  // from the middle of a body to the nearest person
constexpr std::array kCameras{"visible", "thermal"};

struct DetectorOptions {
  std::vector<fs::path> runs, recordings;
  double within_m = 10;
  bool json = false;
};

/// Of all runs, by camera.
struct Bodies {
  std::array<std::vector<LookedAt>, kCameras.size()> of_camera;
  std::uint64_t unclear = 0;  ///< beside somebody, or somebody whom the LiDAR hardly sees
};

/// None: unclear.
std::optional<bool> is_person(const PeopleScan& scan, const Eigen::Vector2d& at) {
  const auto away = [&](const PeopleScan::Person& p) { return (p.position_world - at).norm(); };
  const auto nearest = std::ranges::min_element(scan.people, {}, away);
  if (nearest == scan.people.end() || away(*nearest) > kAtNobody_m) return false;
  if (away(*nearest) < kAtSomebody_m && nearest->seen >= kVisibleReturns) return true;
  return std::nullopt;
}

const PeopleScan* scan_at(const std::vector<PeopleScan>& scans, Time t) {
  const auto after = std::ranges::lower_bound(scans, t - kSameScan, {}, &PeopleScan::stamp);
  return after == scans.end() || after->stamp > t + kSameScan ? nullptr : &*after;
}

Result<void> add_run(const fs::path& run, const fs::path& recording, double within_m, Bodies& bodies) {
  const auto answers = read_answers(run / "answers.csv");
  if (!answers && answers.error().code == Errc::kNotFound)
    return Error{Errc::kNotFound,
                 "the run kept no answers of detectors",
                 (run / "answers.csv").string(),
                 {},
                 "set perception.people.log_answers: true in the profile and run it again"};
  if (!answers) return answers.error();
  const auto T_world_odom = place_of_odom(run, recording);
  if (!T_world_odom) return T_world_odom.error();
  const auto truth = read_people(recording / "people.csv");
  if (!truth) return truth.error();
  const auto chosen = app::choose_profile({}, recording);
  if (!chosen) return chosen.error();
  const auto scans = people_scans(recording, chosen->profile, *truth);
  if (!scans) return scans.error();
  for (const AnswerRow& row : *answers) {
    const PeopleScan* scan = row.distance_m < within_m ? scan_at(*scans, row.stamp) : nullptr;
    if (scan == nullptr) continue;
    const auto person = is_person(*scan, middle_in_world(*T_world_odom, row.position, row.ground));
    if (person)
      bodies.of_camera[row.thermal ? 1 : 0].push_back({*person, row.boxed, row.score});
    else
      ++bodies.unclear;
  }
  return {};
}

report::Json to_json(const DetectorFit& f) {
  report::Json boxes = report::Json::array();
  for (const DetectorFit::Bin& bin : f.boxes) boxes.push_back({{"people", bin.people}, {"others", bin.others}});
  return {{"people", f.people},
          {"others", f.others},
          {"people_boxed", f.people_boxed},
          {"others_boxed", f.others_boxed},
          {"boxes_by_score", boxes},
          {"recall", f.recall},
          {"false_share", f.false_share},
          {"usual_score", f.usual_score},
          {"score_slope", f.score_slope},
          {"slope_sigma", f.slope_sigma}};
}

void print(const char* camera, const DetectorFit& f, double within_m) {
  std::cout << fmt::format("{}: {} bodies of people, {} of others, nearer than {} m\n", camera, f.people, f.others,
                           within_m);
  for (std::size_t i = 0; i < f.boxes.size(); ++i)
    if (const auto& [people, others] = f.boxes[i]; people + others > 0)
      std::cout << fmt::format("  score {:.1f} to {:.1f}: boxes of {} people, {} others\n",
                               static_cast<double>(i) / DetectorFit::kBins,
                               static_cast<double>(i + 1) / DetectorFit::kBins, people, others);
  if (f.score_slope > 0)
    std::cout << fmt::format("  the slope is {:.1f} ± {:.1f}\n", f.score_slope, f.slope_sigma);
  else
    std::cout << "  too few boxes on others for a slope, or a larger score says less\n";
  std::cout << fmt::format(
      "  for perception.people:\n"
      "    {}: {{recall: {:.3f}, false_share: {:.3f}, usual_score: {:.2f}, score_slope: {:.1f}, farthest_m: {}}}\n",
      camera, f.recall, f.false_share, f.usual_score, f.score_slope, within_m);
}

Result<Bodies> gather(const DetectorOptions& options) {
  if (options.runs.size() != options.recordings.size())
    return Error{Errc::kInvalidConfig,
                 "each run needs its recording",
                 {},
                 {},
                 fmt::format("{} runs, {} recordings: name them with --ground-truth in the same order",
                             options.runs.size(), options.recordings.size())};
  Bodies bodies;
  for (std::size_t i = 0; i < options.runs.size(); ++i)
    if (const auto added = add_run(options.runs[i], options.recordings[i], options.within_m, bodies); !added)
      return added.error();
  return bodies;
}

int evaluate_detectors(const DetectorOptions& options) {
  const auto bodies =
      app::while_working("placing the recordings' returns in the world", [&] { return gather(options); });
  if (!bodies) return app::fail(bodies.error());
  report::Json json = {{"within_m", options.within_m}, {"unclear", bodies->unclear}};
  for (std::size_t c = 0; c < kCameras.size(); ++c) {
    const auto fit = fit_detector(bodies->of_camera[c]);
    json[kCameras[c]] = fit ? to_json(*fit) : report::Json(nullptr);
    if (options.json) continue;
    if (fit)
      print(kCameras[c], *fit, options.within_m);
    else
      std::cout << fmt::format("{}: fewer than {} bodies of either kind, or no box at a person\n", kCameras[c],
                               kFewestBodies);
  }
  if (options.json) return app::print(json);
  std::cout << fmt::format("{} bodies beside somebody do not count\n", bodies->unclear);
  return app::kDone;
}

}  // namespace

void add_evaluate_detectors_command(app::Commands& commands, CLI::App& evaluate) {
  CLI::App* sub = evaluate.add_subcommand(
      "detectors", "counts what the detectors of people said in runs of simulated recordings, for the profile");
  const auto o = std::make_shared<DetectorOptions>();
  sub->footer(
      "The runs need perception.people.log_answers: true. A body less than 0.5 m from somebody whom the LiDAR sees is "
      "a person, one more than 1 m from everybody is another thing.");
  sub->add_option("runs", o->runs, "folders of runs: answers.csv and trajectory.tum")
      ->required()
      ->check(CLI::ExistingDirectory);
  sub->add_option("--ground-truth", o->recordings, "the simulated recording of each run, in the same order")
      ->required()
      ->check(CLI::ExistingDirectory);
  sub->add_option("--within", o->within_m, "bodies farther along the view do not count, m; farthest_m of the profile")
      ->check(app::above_zero)
      ->capture_default_str();
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->callback([&commands, o] { commands.job = [o] { return evaluate_detectors(*o); }; });
}

}  // namespace cairn::cli
