// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/stereo_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "onboard/app/cli/working_line.hpp"
#include "onboard/perception/calibration/stereo_calibration.hpp"
#include "tools/cli/calibrate/board_options.hpp"
#include "tools/cli/calibrate/eye_figures.hpp"

namespace cairn::cli {
namespace {

using calibration::StereoCalibration;

constexpr std::size_t kMostPairs = 60;
constexpr double kToDegrees = 180 / std::numbers::pi;

/// The search and the calibration.
struct StereoResult {
  BoardsFound found;
  StereoCalibration calibration;
};

Result<StereoResult> calibrate_pairs(const BoardSearch& search, cameras::DistortionModel model) {
  auto found = search_boards(search);
  if (!found) return found.error();
  const auto left = found->corners(0), right = found->corners(1);
  std::vector<calibration::Corners> chosen_left, chosen_right;
  for (const std::size_t i : calibration::select_views(search.board, left, found->width, found->height, kMostPairs)) {
    chosen_left.push_back(left[i]);
    chosen_right.push_back(right[i]);
  }
  auto done =
      calibration::calibrate_stereo(search.board, chosen_left, chosen_right, found->width, found->height, model);
  if (!done) {
    Error error = at(search.recordings[0].string(), done.error());
    error.detail += fmt::format("; {} pictures, both eyes see the board in {}", found->pictures, left.size());
    return error;
  }
  return StereoResult{.found = *std::move(found), .calibration = *std::move(done)};
}

/// Rotation vector of T_right_left, degrees.
Eigen::Vector3d rotation_deg(const StereoCalibration& s) { return kToDegrees * s.T_right_left.log().tail<3>(); }

report::Json stereo_json(const StereoResult& r, const BoardOptions& o) {
  const StereoCalibration& s = r.calibration;
  const Eigen::Vector3d turn = rotation_deg(s);
  report::Json json{{"pictures", r.found.pictures},
                    {"unreadable_packets", r.found.unreadable},
                    {"with_board", r.found.boards.size()},
                    {"views", s.views.size()},
                    {"dropped_views", s.dropped.size()},
                    {"accepted", s.faults.empty()},
                    {"faults", s.faults},
                    {"left", eye_json(s.eyes[0])},
                    {"right", eye_json(s.eyes[1])},
                    {"baseline_m", number(s.baseline_m)},
                    {"baseline_deviation_m", number(s.baseline_deviation_m)},
                    {"rotation_deg", {turn.x(), turn.y(), turn.z()}}};
  for (Eigen::Index i = 0; i < 3; ++i) json["rotation_deviation_deg"].push_back(number(s.rotation_deviation_deg(i)));
  json["epipolar_rms_px"] = number(s.epipolar_rms_px);
  json["coverage"] = coverage_json(s.coverage);
  json["out"] = s.faults.empty() ? report::Json(o.out.string()) : report::Json(nullptr);
  return json;
}

void print_stereo(const StereoResult& r) {
  const StereoCalibration& s = r.calibration;
  const Eigen::Vector3d turn = rotation_deg(s);
  std::cout << fmt::format("{} pictures, both eyes see the board in {}, {} different views used, {} dropped\n",
                           r.found.pictures, r.found.boards.size(), s.views.size(), s.dropped.size())
            << "left eye\n"
            << eye_text(s.eyes[0]) << "right eye\n"
            << eye_text(s.eyes[1]) << fmt::format("baseline {:.5f} ± {:.5f} m\n", s.baseline_m, s.baseline_deviation_m)
            << fmt::format("rotation {:.3f} {:.3f} {:.3f} ± {:.3f} {:.3f} {:.3f} degrees about x, y, z\n", turn.x(),
                           turn.y(), turn.z(), s.rotation_deviation_deg(0), s.rotation_deviation_deg(1),
                           s.rotation_deviation_deg(2))
            << fmt::format("corners are {:.3f} px from their epipolar lines (root mean square)\n", s.epipolar_rms_px);
  print_verdict(s.faults, s.coverage.missing());
}

int calibrate_stereo_cameras(const BoardOptions& o) {
  const auto search = search_of(o, BoardSearch::Eyes::kBoth);
  if (!search) return app::fail(search.error());
  const auto model =
      o.model == "equidistant" ? cameras::DistortionModel::kEquidistant : cameras::DistortionModel::kRadTan;
  const auto result = app::while_working("looking for the board", [&] { return calibrate_pairs(*search, model); });
  if (!result) return app::fail(result.error());
  const StereoCalibration& s = result->calibration;
  if (s.faults.empty()) {
    const cameras::Calibration file{.format = cameras::CalibrationFormat::kKalibr,
                                    .cameras = {{.parameters = s.eyes[0].parameters},
                                                {.parameters = s.eyes[1].parameters, .baseline_m = s.baseline_m}}};
    if (auto written = write_calibration(o.out, "kalibr", file); !written) return app::fail(written.error());
  }
  if (o.json)
    (void)app::print(stereo_json(*result, o));
  else
    print_stereo(*result);
  return s.faults.empty() ? app::kDone : app::kFailed;
}

}  // namespace

void add_calibrate_stereo(app::Commands& commands, CLI::App& calibrate) {
  CLI::App* sub =
      calibrate.add_subcommand("stereo", "both eyes of side-by-side pictures: intrinsics, baseline, rotation");
  const auto o = std::make_shared<BoardOptions>();
  add_board_options(*sub, *o);
  sub->add_option("--model", o->model, "lens: radtan (k1 k2 p1 p2), or equidistant (fisheye, k1 to k4)")
      ->check(CLI::IsMember({"radtan", "equidistant"}))
      ->capture_default_str();
  sub->callback([&commands, o] { commands.job = [o] { return calibrate_stereo_cameras(*o); }; });
}

}  // namespace cairn::cli
