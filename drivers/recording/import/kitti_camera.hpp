// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/se3.hpp"

// The left colour camera of KITTI raw (image_02). Its pictures are rectified: a pinhole without distortion, turned by
// R_rect_00 against the camera itself. (Geiger et al., "Vision meets Robotics: The KITTI Dataset", IJRR 2013)
namespace cairn::recording {

/// Of the rectified camera, pixels from the centre of the upper left one; and where it is.
struct KittiCamera {
  double fx = 0, fy = 0, cx = 0, cy = 0;
  SE3 T_optical_velodyne;  ///< optical frame: x right, y down, z along the view
};

/// From P_rect_02, R_rect_00 and either R and T of the LiDAR (KITTI's two files, one after the other) or
/// T_velo_to_cam0. None: the text has no P_rect_02. Errors: kNotFound for another key, kMalformed.
[[nodiscard]] Result<std::optional<KittiCamera>> parse_kitti_camera(std::string_view text, std::string_view name);

/// The calibration of a drive: calib.txt in its folder, or calib_cam_to_cam.txt and calib_velo_to_cam.txt, there or in
/// the folder of the day above it. None: there are no such files.
[[nodiscard]] Result<std::optional<KittiCamera>> find_kitti_camera(const std::filesystem::path& drive);

/// What the profile of the recording says: the camera's size and rate, its intrinsics, and the mounts of camera and
/// LiDAR. base_link is the LiDAR's frame.
[[nodiscard]] std::string kitti_profile(const std::string& robot, const KittiCamera& camera, std::uint32_t width,
                                        std::uint32_t height, double rate_hz);

}  // namespace cairn::recording
