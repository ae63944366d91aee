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
#include "tools/cli/calibrate/mounts.hpp"
#include "tools/cli/calibrate/still_boards.hpp"

namespace cairn::cli {
namespace {

using calibration::MountCalibration;

/// The search and the calibration.
struct MountResult {
  BoardsFound found;
  std::size_t still = 0;  ///< times in which the board stood still
  SE3 T_base_lidar;
  MountCalibration calibration;
};

Result<MountResult> calibrate_mounts(const BoardSearch& search) {
  auto found = search_boards(search);
  if (!found) return found.error();
  const auto chosen_profile = app::choose_profile(search.config, search.recordings[0]);
  if (!chosen_profile) return chosen_profile.error();
  const app::RobotProfile& profile = chosen_profile->profile;
  const auto start = mounted_eye(profile, search, *found);
  if (!start) return start.error();
  const auto still = find_still(*found);
  const auto chosen = different_boards(search.board, *found, still);
  std::vector<calibration::BoardPose> poses;
  for (const StillBoard& s : chosen) poses.push_back({.corners = s.corners, .points = {}});
  for (std::size_t i = 0; i < search.recordings.size(); ++i)
    if (auto read =
            add_scans(search.recordings[i], i, profile, search.board, start->eye, start->T_base_camera, chosen, poses);
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
                     .T_base_lidar = profile.robot().T_base_lidar,
                     .calibration = *std::move(done)};
}

std::string section_of(const MountCalibration& m, bool thermal) {
  return mount_section(
      fmt::format("{}: {} poses, {} points\n# residuals: {:.4f} m, {:.3f} px (root mean squares)",
                  thermal ? "thermal" : "lidar-camera", m.used.size(), m.points, m.point_rms_m, m.corner_rms_px),
      m.T_points_camera, m.deviations, thermal);
}

report::Json mount_json(const MountResult& r, const BoardOptions& o) {
  const MountCalibration& m = r.calibration;
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
  json[mount_name(o.thermal)] = numbers(m.T_points_camera.xyz_rpy());
  json[o.thermal ? "T_lidar_thermal" : "T_lidar_camera"] =
      numbers((r.T_base_lidar.inverse() * m.T_points_camera).xyz_rpy());
  json["deviations"] = numbers(m.deviations);
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
  std::cout << mount_text(m.T_points_camera, m.deviations);
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
    if (auto written = write_file_atomic(o.out, section_of(result->calibration, o.thermal)); !written)
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
