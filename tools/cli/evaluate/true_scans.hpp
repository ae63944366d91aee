// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "tools/cli/evaluate/path.hpp"

namespace cairn::cli {

/// A sweep of a simulated LiDAR whose returns say what they met.
struct TrueScan {
  /// One return.
  struct Return {
    Eigen::Vector3f point;  ///< metres, in the frame of the path, which says where the robot was when it came back
    float range_m;          ///< from the sensor
    std::uint8_t class_id;  ///< trainId, or kNoClass
  };
  Time stamp{};  ///< end of the sweep; the poses are of this instant
  SE3 T_path_base, T_path_lidar;
  std::vector<Return> returns;
};

/// Decodes the LiDAR of a simulated recording, places its returns along `path`, and calls `use` for each sweep. It
/// takes lidar_labels.bin of the recording, and the LiDAR's settings and mount of `profile`. Errors: those of the
/// files; kNotFound where the recording has no Velodyne packets or no lidar_labels.bin; kMalformed where
/// lidar_labels.bin has not one entry for each return.
[[nodiscard]] Result<void> for_each_true_scan(const std::filesystem::path& recording, const app::RobotProfile& profile,
                                              const Path& path, const std::function<void(const TrueScan&)>& use);

}  // namespace cairn::cli
