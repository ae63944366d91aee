// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hal/result.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "onboard/report/json/report_json.hpp"
#include "tools/cli/calibrate/board_search.hpp"
#include "tools/cli/calibrate/still_boards.hpp"

namespace cairn::cli {

/// A calibrated camera, and where the profile believes it to be.
struct MountedEye {
  cameras::CameraModel eye;
  SE3 T_base_camera;  ///< body axes
};

/// The camera whose pictures were searched. Error kInvalidConfig: it has no intrinsics of this size.
[[nodiscard]] Result<MountedEye> mounted_eye(const app::RobotProfile& profile, const BoardSearch& search,
                                             const BoardsFound& found);

/// The still boards that differ most, at most 60.
[[nodiscard]] std::vector<StillBoard> different_boards(const calibration::Board& board, const BoardsFound& found,
                                                       const std::vector<StillBoard>& still);

/// The key of a profile: T_base_thermal or T_base_camera.
[[nodiscard]] const char* mount_name(bool thermal);
/// The section of a profile, with what made it and its deviations as comments. `made_by`: without the first `# `.
[[nodiscard]] std::string mount_section(const std::string& made_by, const SE3& T_base_camera, const Vector6& deviations,
                                        bool thermal);
/// The six numbers with their deviations, a line each.
[[nodiscard]] std::string mount_text(const SE3& mount, const Vector6& deviations);
/// x y z roll pitch yaw as a list; null where a number is not finite.
[[nodiscard]] report::Json numbers(const Vector6& xyz_rpy);

}  // namespace cairn::cli
