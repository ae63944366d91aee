// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/camera_thermal_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "hal/files/file.hpp"
#include "onboard/app/cli/working_line.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "onboard/perception/calibration/pair_calibration.hpp"
#include "tools/cli/calibrate/board_options.hpp"
#include "tools/cli/calibrate/eye_figures.hpp"
#include "tools/cli/calibrate/mounts.hpp"

namespace cairn::cli {
namespace {

using calibration::Corners;
using calibration::PairCalibration;
using calibration::PairView;

/// What one of the two cameras showed.
struct Side {
  BoardsFound found;
  std::vector<StillBoard> still;
};

/// The search and the calibration.
struct PairResult {
  Side camera, thermal;
  std::size_t together = 0;  ///< times in which both saw the board stand still
  SE3 T_base_camera, T_base_lidar;
  SE3 T_base_thermal_before;  ///< as the profile says
  PairCalibration calibration;

  [[nodiscard]] SE3 T_base_thermal() const { return T_base_camera * calibration.T_first_second; }
};

Result<Side> look(BoardSearch search, bool thermal) {
  search.inverted = thermal && search.inverted;
  search.thermal = thermal;
  auto found = search_boards(search);
  if (!found) return found.error();
  Side side{.found = *std::move(found), .still = {}};
  side.still = find_still(side.found);
  return side;
}

/// A board looks the same from its other end: the corners in the order in which the believed mount expects them.
Corners as_expected(const calibration::Board& board, const MountedEye& camera, const MountedEye& thermal,
                    const Corners& in_camera, const Corners& in_thermal) {
  const auto T_camera_board = calibration::board_pose(camera.eye.parameters(), board, in_camera);
  if (!T_camera_board) return in_thermal;
  const SE3 C = cameras::T_camera_optical();
  const SE3 T = (thermal.T_base_camera * C).inverse() * camera.T_base_camera * C * *T_camera_board;
  Corners expected;
  for (std::size_t i = 0; i < board.corners(); ++i) {
    const auto seen = calibration::see(thermal.eye.parameters(), T * board.corner(i));
    if (!seen) return in_thermal;
    expected.push_back(seen->pixel);
  }
  return calibration::ordered_like(expected, in_thermal);
}

/// The boards of the colour camera that stood still while one of the thermal camera did.
std::vector<StillBoard> seen_by_both(const Side& camera, const StillBoard& thermal) {
  std::vector<StillBoard> same;
  for (const StillBoard& s : camera.still)
    if (s.recording == thermal.recording &&
        std::min(s.last, thermal.last) - std::max(s.first, thermal.first) >= kLeastStillTime)
      same.push_back(s);
  return same;
}

Result<PairResult> calibrate_cameras(const BoardSearch& search) {
  const auto chosen = app::choose_profile(search.config, search.recordings[0]);
  if (!chosen) return chosen.error();
  auto camera = look(search, false);
  if (!camera) return camera.error();
  auto thermal = look(search, true);
  if (!thermal) return thermal.error();
  BoardSearch by_thermal = search;
  by_thermal.thermal = true;
  const auto first = mounted_eye(chosen->profile, search, camera->found);
  if (!first) return first.error();
  const auto second = mounted_eye(chosen->profile, by_thermal, thermal->found);
  if (!second) return second.error();
  std::vector<PairView> views;
  for (const StillBoard& t : different_boards(search.board, thermal->found, thermal->still))
    for (const StillBoard& c : seen_by_both(*camera, t))
      views.push_back({c.corners, as_expected(search.board, *first, *second, c.corners, t.corners)});
  auto done = calibration::calibrate_pair(search.board, views, first->eye, second->eye);
  if (!done) {
    Error error = at(search.recordings[0].string(), done.error());
    error.detail += fmt::format("; the colour camera saw it still {} times, the thermal one {} times",
                                camera->still.size(), thermal->still.size());
    return error;
  }
  return PairResult{.camera = *std::move(camera),
                    .thermal = *std::move(thermal),
                    .together = views.size(),
                    .T_base_camera = first->T_base_camera,
                    .T_base_lidar = chosen->profile.robot().T_base_lidar,
                    .T_base_thermal_before = second->T_base_camera,
                    .calibration = *std::move(done)};
}

/// How far the profile's own mount is from the product of the other two.
SE3 apart(const PairResult& r) { return r.T_base_thermal().inverse() * r.T_base_thermal_before; }

report::Json pair_json(const PairResult& r, const BoardOptions& o) {
  const PairCalibration& c = r.calibration;
  return {{"still", {{"camera", r.camera.still.size()}, {"thermal", r.thermal.still.size()}, {"both", r.together}}},
          {"views", c.used.size()},
          {"dropped", c.dropped.size()},
          {"corner_rms_px", {{"camera", number(c.corner_rms_px[0])}, {"thermal", number(c.corner_rms_px[1])}}},
          {"T_camera_thermal", numbers(c.T_first_second.xyz_rpy())},
          {"deviations", numbers(c.deviations)},
          {"T_base_thermal", numbers(r.T_base_thermal().xyz_rpy())},
          {"T_lidar_thermal", numbers((r.T_base_lidar.inverse() * r.T_base_thermal()).xyz_rpy())},
          {"profile_apart",
           {{"m", number(apart(r).translation().norm())},
            {"deg", number(rotation_angle(apart(r)) / calibration::kDegree)}}},
          {"accepted", c.faults.empty()},
          {"faults", c.faults},
          {"coverage", coverage_json(c.coverage)},
          {"out", c.faults.empty() ? report::Json(o.out.string()) : report::Json(nullptr)}};
}

void print_pair(const PairResult& r) {
  const PairCalibration& c = r.calibration;
  std::cout << fmt::format(
                   "the board stood still {} times for the colour camera, {} times for the thermal one, {} times "
                   "for both\n",
                   r.camera.still.size(), r.thermal.still.size(), r.together)
            << fmt::format("{} views used, {} dropped as outliers\n", c.used.size(), c.dropped.size())
            << fmt::format("residuals of corners: {:.3f} px in the colour camera, {:.3f} px in the thermal one\n",
                           c.corner_rms_px[0], c.corner_rms_px[1])
            << "T_camera_thermal\n"
            << mount_text(c.T_first_second, c.deviations)
            << fmt::format("the profile's own T_base_thermal is {:.3f} m and {:.2f} degrees beside the product\n",
                           apart(r).translation().norm(), rotation_angle(apart(r)) / calibration::kDegree);
  print_verdict(c.faults, c.faults.empty() ? std::vector<std::string>{} : c.coverage.missing());
}

int calibrate_camera_thermal(const BoardOptions& o) {
  const auto search = search_of(o, BoardSearch::Eyes::kLeft);
  if (!search) return app::fail(search.error());
  const auto result =
      app::while_working("looking for the board in both cameras", [&] { return calibrate_cameras(*search); });
  if (!result) return app::fail(result.error());
  const PairCalibration& c = result->calibration;
  const std::string made_by = fmt::format(
      "camera-thermal: {} views; T_base_camera of the profile times T_camera_thermal\n"
      "# residuals: {:.3f} and {:.3f} px (root mean squares)",
      c.used.size(), c.corner_rms_px[0], c.corner_rms_px[1]);
  if (c.faults.empty())
    if (auto written = write_file_atomic(o.out, mount_section(made_by, result->T_base_thermal(), c.deviations, true));
        !written)
      return app::fail(written.error());
  if (o.json)
    (void)app::print(pair_json(*result, o));
  else
    print_pair(*result);
  return c.faults.empty() ? app::kDone : app::kFailed;
}

}  // namespace

void add_calibrate_camera_thermal(app::Commands& commands, CLI::App& calibrate) {
  CLI::App* sub =
      calibrate.add_subcommand("camera-thermal", "mount of the thermal camera, by heated boards that both cameras see");
  const auto o = std::make_shared<BoardOptions>();
  add_board_options(*sub, *o);
  add_inverted_option(*sub, *o);
  sub->callback([&commands, o] { commands.job = [o] { return calibrate_camera_thermal(*o); }; });
}

}  // namespace cairn::cli
