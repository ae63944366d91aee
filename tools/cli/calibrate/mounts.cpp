// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/calibrate/mounts.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "tools/cli/calibrate/eye_figures.hpp"

namespace cairn::cli {
namespace {

constexpr std::size_t kMostPoses = 60;
constexpr std::array kAxes{"x", "y", "z", "roll", "pitch", "yaw"};

}  // namespace

Result<MountedEye> mounted_eye(const app::RobotProfile& profile, const BoardSearch& search, const BoardsFound& found) {
  const auto& intrinsics = search.thermal ? profile.thermal.intrinsics : profile.camera.intrinsics;
  const auto& mount = search.thermal ? profile.thermal.base_xyz_rpy : profile.camera.base_xyz_rpy;
  const auto eye = intrinsics.model(found.width, found.height);
  if (!eye && eye.error().code == Errc::kNotFound)
    return Error{Errc::kInvalidConfig,
                 search.thermal ? "the thermal camera is not calibrated" : "the camera is not calibrated",
                 search.recordings[0].string(),
                 {},
                 fmt::format("run cairn calibrate camera{} first, and name its file in {}.intrinsics.calibration of "
                             "--config",
                             search.thermal ? " --thermal" : "", search.thermal ? "thermal" : "camera")};
  if (!eye) return eye.error();
  return MountedEye{.eye = *eye, .T_base_camera = SE3::from_xyz_rpy(Eigen::Map<const Vector6>(mount.data()))};
}

std::vector<StillBoard> different_boards(const calibration::Board& board, const BoardsFound& found,
                                         const std::vector<StillBoard>& still) {
  std::vector<calibration::Corners> corners;
  for (const StillBoard& s : still) corners.push_back(s.corners);
  std::vector<StillBoard> chosen;
  for (const std::size_t i : calibration::select_views(board, corners, found.width, found.height, kMostPoses))
    chosen.push_back(still[i]);
  return chosen;
}

const char* mount_name(bool thermal) { return thermal ? "T_base_thermal" : "T_base_camera"; }

std::string mount_section(const std::string& made_by, const SE3& T_base_camera, const Vector6& s, bool thermal) {
  const Vector6 mount = T_base_camera.xyz_rpy();
  return fmt::format(
      "# cairn calibrate {}\n"
      "# standard deviations: x {:.4f}, y {:.4f}, z {:.4f} m, roll {:.5f}, pitch {:.5f}, yaw {:.5f} rad\n"
      "{}\n  {}: [{:.6f}, {:.6f}, {:.6f}, {:.7f}, {:.7f}, {:.7f}]\n",
      made_by, s[0], s[1], s[2], s[3], s[4], s[5], thermal ? "thermal:" : "camera:", mount_name(thermal), mount[0],
      mount[1], mount[2], mount[3], mount[4], mount[5]);
}

std::string mount_text(const SE3& mount, const Vector6& deviations) {
  const Vector6 values = mount.xyz_rpy();
  std::string text;
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    text += i < 3 ? fmt::format("{:<5} {:>9.4f} ± {:.4f} m\n", kAxes[i], values[k], deviations[k])
                  : fmt::format("{:<5} {:>9.3f} ± {:.3f} degrees\n", kAxes[i], values[k] / calibration::kDegree,
                                deviations[k] / calibration::kDegree);
  }
  return text;
}

report::Json numbers(const Vector6& xyz_rpy) {
  report::Json list = report::Json::array();
  for (Eigen::Index i = 0; i < 6; ++i) list.push_back(number(xyz_rpy[i]));
  return list;
}

}  // namespace cairn::cli
