// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "hal/result.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/perception/calibration/lidar_calibration.hpp"
#include "tools/cli/calibrate/board_search.hpp"

namespace cairn::cli {

/// A time in which neither board nor camera moved.
struct StillBoard {
  std::size_t recording = 0;     ///< index
  Time first{}, last{};          ///< of the pictures
  std::size_t pictures = 0;      ///< at least kLeastStill
  calibration::Corners corners;  ///< mean of the pictures
};

inline constexpr std::size_t kLeastStill = 3;  ///< pictures
inline constexpr Duration kLeastStillTime = std::chrono::milliseconds(300);
inline constexpr Duration kMostStillGap = std::chrono::seconds(1);  ///< between two pictures of one still time
inline constexpr double kMostStillMotion = 0.002;                   ///< of a corner, as a share of the picture's width

/// The times in which the corners of the first eye stand still, in order.
[[nodiscard]] std::vector<StillBoard> find_still(const BoardsFound& found);

/// Reads the scans of one recording that were taken while a board stood still, and adds their points near the board, in
/// base_link, to `poses`, one a board; boards of other recordings are left alone. Errors: those of the recording;
/// kNotFound: it has no LiDAR.
[[nodiscard]] Result<void> add_scans(const std::filesystem::path& recording, std::size_t index,
                                     const app::RobotProfile& profile, const calibration::Board& board,
                                     const cameras::CameraModel& eye, const SE3& T_base_camera,
                                     const std::vector<StillBoard>& still, std::vector<calibration::BoardPose>& poses);

}  // namespace cairn::cli
