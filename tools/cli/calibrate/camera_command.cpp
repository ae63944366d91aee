// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/camera_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "onboard/app/cli/working_line.hpp"
#include "onboard/perception/calibration/camera_calibration.hpp"
#include "tools/cli/calibrate/board_options.hpp"
#include "tools/cli/calibrate/eye_figures.hpp"

namespace cairn::cli {
namespace {

using calibration::CameraCalibration;

constexpr std::size_t kMostViews = 60;

/// The search, the views that were chosen of it, and the calibration.
struct CameraResult {
  BoardsFound found;
  std::vector<std::size_t> chosen;
  CameraCalibration calibration;
};

Result<CameraResult> calibrate(const BoardSearch& search, cameras::DistortionModel model) {
  auto found = search_boards(search);
  if (!found) return found.error();
  const auto all = found->corners(0);
  auto chosen = calibration::select_views(search.board, all, found->width, found->height, kMostViews);
  std::vector<calibration::Corners> views;
  for (const std::size_t i : chosen) views.push_back(all[i]);
  auto done = calibration::calibrate_camera(search.board, views, found->width, found->height, model);
  if (!done) {
    Error error = at(search.recordings[0].string(), done.error());
    error.detail += fmt::format("; {} pictures, the board in {}", found->pictures, all.size());
    return error;
  }
  return CameraResult{.found = *std::move(found), .chosen = std::move(chosen), .calibration = *std::move(done)};
}

report::Json to_json(const CameraResult& r, const BoardOptions& o) {
  report::Json json{{"pictures", r.found.pictures},
                    {"unreadable_packets", r.found.unreadable},
                    {"with_board", r.found.boards.size()},
                    {"dropped_views", r.calibration.dropped.size()},
                    {"accepted", r.calibration.faults.empty()},
                    {"faults", r.calibration.faults},
                    {"camera", eye_json(r.calibration.eye)},
                    {"coverage", coverage_json(r.calibration.coverage)},
                    {"views", report::Json::array()}};
  for (const calibration::ViewError& view : r.calibration.views) {
    const SeenBoard& seen = r.found.boards[r.chosen[view.view]];
    json["views"].push_back({{"recording", o.recordings[seen.recording].string()},
                             {"stamp_ns", seen.stamp.time_since_epoch().count()},
                             {"rms_px", view.rms_px}});
  }
  json["out"] = r.calibration.faults.empty() ? report::Json(o.out.string()) : report::Json(nullptr);
  return json;
}

void print_figures(const CameraResult& r) {
  std::cout << fmt::format("{} pictures, the board in {} of them, {} different views used, {} dropped as outliers\n",
                           r.found.pictures, r.found.boards.size(), r.calibration.views.size(),
                           r.calibration.dropped.size())
            << eye_text(r.calibration.eye);
  print_verdict(r.calibration.faults, r.calibration.coverage.missing());
}

int calibrate_camera(const BoardOptions& o) {
  const auto search = search_of(o, BoardSearch::Eyes::kLeft);
  if (!search) return app::fail(search.error());
  const auto model =
      o.model == "equidistant" ? cameras::DistortionModel::kEquidistant : cameras::DistortionModel::kRadTan;
  const auto result = app::while_working("looking for the board", [&] { return calibrate(*search, model); });
  if (!result) return app::fail(result.error());
  const bool accepted = result->calibration.faults.empty();
  if (accepted) {
    const cameras::Calibration file{.format = cameras::CalibrationFormat::kKalibr,
                                    .cameras = {{.parameters = result->calibration.eye.parameters}}};
    if (auto written = write_calibration(o.out, o.format, file); !written) return app::fail(written.error());
  }
  if (o.json)
    (void)app::print(to_json(*result, o));
  else
    print_figures(*result);
  return accepted ? app::kDone : app::kFailed;
}

}  // namespace

void add_calibrate_camera(app::Commands& commands, CLI::App& calibrate) {
  CLI::App* sub = calibrate.add_subcommand("camera", "intrinsics of a camera, or of the left eye of two");
  const auto o = std::make_shared<BoardOptions>();
  add_board_options(*sub, *o);
  add_lens_options(*sub, *o);
  sub->add_flag("--thermal", o->thermal, "intrinsics of the thermal camera, by a heated board");
  add_inverted_option(*sub, *o);
  sub->callback([&commands, o] { commands.job = [o] { return calibrate_camera(*o); }; });
}

}  // namespace cairn::cli
