// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/lidar_camera_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hal/files/file.hpp"
#include "onboard/app/cli/working_line.hpp"
#include "onboard/app/profile/recorded_profile.hpp"
#include "tools/cli/calibrate/board_options.hpp"
#include "tools/cli/calibrate/eye_figures.hpp"
#include "tools/cli/calibrate/still_boards.hpp"

namespace cairn::cli {
namespace {

using calibration::MountCalibration;

constexpr std::size_t kMostPoses = 60;
constexpr std::array kAxes{"x", "y", "z", "roll", "pitch", "yaw"};

/// The search and the calibration.
struct MountResult {
  BoardsFound found;
  std::size_t still = 0;  ///< times in which the board stood still
  SE3 T_base_lidar;
  MountCalibration calibration;
};

/// What the first recording's profile says.
struct Believed {
  app::RobotProfile profile;
  cameras::CameraModel eye;
  SE3 T_base_camera;
};

Result<Believed> believed(const BoardSearch& search, const BoardsFound& found) {
  const auto chosen = app::choose_profile(search.config, search.recordings[0]);
  if (!chosen) return chosen.error();
  const app::RobotProfile& profile = chosen->profile;
  const auto& intrinsics = search.thermal ? profile.thermal.intrinsics : profile.camera.intrinsics;
  const auto& mount = search.thermal ? profile.thermal.base_xyz_rpy : profile.camera.base_xyz_rpy;
  auto eye = intrinsics.model(found.width, found.height);
  if (!eye && eye.error().code == Errc::kNotFound)
    return Error{Errc::kInvalidConfig,
                 "the camera is not calibrated",
                 search.recordings[0].string(),
                 {},
                 "run cairn calibrate camera first, and name its file in intrinsics.calibration of --config"};
  if (!eye) return eye.error();
  return Believed{.profile = chosen->profile,
                  .eye = *eye,
                  .T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(mount.data()))};
}

/// The still boards that differ most.
std::vector<StillBoard> different(const BoardSearch& search, const BoardsFound& found,
                                  const std::vector<StillBoard>& still) {
  std::vector<calibration::Corners> corners;
  for (const StillBoard& s : still) corners.push_back(s.corners);
  std::vector<StillBoard> chosen;
  for (const std::size_t i : calibration::select_views(search.board, corners, found.width, found.height, kMostPoses))
    chosen.push_back(still[i]);
  return chosen;
}

Result<MountResult> calibrate_mounts(const BoardSearch& search) {
  auto found = search_boards(search);
  if (!found) return found.error();
  const auto start = believed(search, *found);
  if (!start) return start.error();
  const auto still = find_still(*found);
  const auto chosen = different(search, *found, still);
  std::vector<calibration::BoardPose> poses;
  for (const StillBoard& s : chosen) poses.push_back({.corners = s.corners, .points = {}});
  for (std::size_t i = 0; i < search.recordings.size(); ++i)
    if (auto read = add_scans(search.recordings[i], i, start->profile, search.board, start->eye, start->T_base_camera,
                              chosen, poses);
        !read)
      return read.error();
  auto done = calibration::calibrate_mount(search.board, poses, start->eye, start->T_base_camera);
  if (!done) {
    Error error = at(search.recordings[0].string(), done.error());
    error.detail += fmt::format("; {} pictures, the board in {}, still {} times", found->pictures, found->boards.size(),
                                still.size());
    return error;
  }
  return MountResult{.found = *std::move(found),
                     .still = still.size(),
                     .T_base_lidar = start->profile.robot().T_base_lidar,
                     .calibration = *std::move(done)};
}

/// The key of a profile.
const char* mount_name(bool thermal) { return thermal ? "T_base_thermal" : "T_base_camera"; }

/// The section of a profile, with deviations as comments.
std::string to_profile(const MountCalibration& m, bool thermal) {
  const Vector6 mount = m.T_points_camera.xyz_rpy(), &s = m.deviations;
  return fmt::format(
      "# cairn calibrate {}: {} poses, {} points\n"
      "# residuals: {:.4f} m, {:.3f} px (root mean squares)\n"
      "# standard deviations: x {:.4f}, y {:.4f}, z {:.4f} m, roll {:.5f}, pitch {:.5f}, yaw {:.5f} rad\n"
      "{}\n  {}: [{:.6f}, {:.6f}, {:.6f}, {:.7f}, {:.7f}, {:.7f}]\n",
      thermal ? "thermal" : "lidar-camera", m.used.size(), m.points, m.point_rms_m, m.corner_rms_px, s[0], s[1], s[2],
      s[3], s[4], s[5], thermal ? "thermal:" : "camera:", mount_name(thermal), mount[0], mount[1], mount[2], mount[3],
      mount[4], mount[5]);
}

report::Json mount_json(const MountResult& r, const BoardOptions& o) {
  const MountCalibration& m = r.calibration;
  const Vector6 mount = m.T_points_camera.xyz_rpy();
  const Vector6 by_lidar = (r.T_base_lidar.inverse() * m.T_points_camera).xyz_rpy();
  report::Json json{{"pictures", r.found.pictures},
                    {"unreadable_packets", r.found.unreadable},
                    {"with_board", r.found.boards.size()},
                    {"still", r.still},
                    {"poses", m.used.size()},
                    {"without_plane", m.no_plane.size()},
                    {"dropped", m.dropped.size()},
                    {"points", m.points},
                    {"point_rms_m", number(m.point_rms_m)},
                    {"corner_rms_px", number(m.corner_rms_px)},
                    {"accepted", m.faults.empty()},
                    {"faults", m.faults}};
  for (Eigen::Index i = 0; i < 6; ++i) {
    json[mount_name(o.thermal)].push_back(number(mount[i]));
    json[o.thermal ? "T_lidar_thermal" : "T_lidar_camera"].push_back(number(by_lidar[i]));
    json["deviations"].push_back(number(m.deviations[i]));
  }
  json["coverage"] = coverage_json(m.coverage);
  json["out"] = m.faults.empty() ? report::Json(o.out.string()) : report::Json(nullptr);
  return json;
}

void print_mount(const MountResult& r) {
  const MountCalibration& m = r.calibration;
  std::cout << fmt::format("{} pictures, the board in {}, still {} times\n", r.found.pictures, r.found.boards.size(),
                           r.still)
            << fmt::format("{} poses used, {} without a plane in the scans, {} dropped as outliers\n", m.used.size(),
                           m.no_plane.size(), m.dropped.size())
            << fmt::format("residuals: {:.4f} m for {} points, {:.3f} px for corners (root mean squares)\n",
                           m.point_rms_m, m.points, m.corner_rms_px);
  const Vector6 mount = m.T_points_camera.xyz_rpy();
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (i < 3)
      std::cout << fmt::format("{:<5} {:>9.4f} ± {:.4f} m\n", kAxes[i], mount[k], m.deviations[k]);
    else
      std::cout << fmt::format("{:<5} {:>9.3f} ± {:.3f} degrees\n", kAxes[i], mount[k] / calibration::kDegree,
                               m.deviations[k] / calibration::kDegree);
  }
  print_verdict(m.faults, m.faults.empty() ? std::vector<std::string>{} : m.coverage.missing());
}

int calibrate_mount_of(const BoardOptions& o) {
  const auto search = search_of(o, BoardSearch::Eyes::kLeft);
  if (!search) return app::fail(search.error());
  const auto result =
      app::while_working("looking for the board and its points", [&] { return calibrate_mounts(*search); });
  if (!result) return app::fail(result.error());
  const bool accepted = result->calibration.faults.empty();
  if (accepted)
    if (auto written = write_file_atomic(o.out, to_profile(result->calibration, o.thermal)); !written)
      return app::fail(written.error());
  if (o.json)
    (void)app::print(mount_json(*result, o));
  else
    print_mount(*result);
  return accepted ? app::kDone : app::kFailed;
}

}  // namespace

void add_calibrate_lidar_camera(app::Commands& commands, CLI::App& calibrate) {
  CLI::App* sub = calibrate.add_subcommand("lidar-camera", "mount of the camera, by boards that the LiDAR sees, too");
  const auto o = std::make_shared<BoardOptions>();
  add_board_options(*sub, *o);
  sub->callback([&commands, o] { commands.job = [o] { return calibrate_mount_of(*o); }; });
}

void add_calibrate_thermal(app::Commands& commands, CLI::App& calibrate) {
  CLI::App* sub = calibrate.add_subcommand("thermal", "mount of the thermal camera, by heated boards and the LiDAR");
  const auto o = std::make_shared<BoardOptions>();
  o->thermal = true;
  add_board_options(*sub, *o);
  add_inverted_option(*sub, *o);
  sub->callback([&commands, o] { commands.job = [o] { return calibrate_mount_of(*o); }; });
}

}  // namespace cairn::cli
