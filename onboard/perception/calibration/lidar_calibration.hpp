// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "onboard/perception/calibration/coverage.hpp"
#include "onboard/perception/calibration/mount_deviations.hpp"
#include "onboard/perception/calibration/plane_problem.hpp"

namespace cairn::calibration {

/// Where a camera is in the frame of the LiDAR's points.
struct MountCalibration {
  SE3 T_points_camera;                   ///< body axes of the camera: x along the view, y left, z up
  Vector6 deviations = Vector6::Zero();  ///< standard deviations of its x y z roll pitch yaw: metres, radians
  double point_rms_m = 0;                ///< distance of points from the boards' planes
  double corner_rms_px = 0;
  std::size_t points = 0;
  std::vector<std::size_t> used;      ///< indices of the given poses
  std::vector<std::size_t> no_plane;  ///< poses without a plane in the points where the board is expected
  std::vector<std::size_t> dropped;   ///< poses that do not fit the others
  Coverage coverage;
  std::vector<std::string> faults;  ///< why it must not be used; empty: it may be used
};

inline constexpr std::size_t kLeastPoses = 12;

/// The pose of a camera from boards that picture and points show. Plane constraints: a board's points lie on the plane
/// that the corners tell. `poses[i].points`: all points near the board, as of near_board(). `T_points_camera`: the
/// mount before. Errors: kNotFound: fewer than kLeastPoses can be used; kDiverged.
[[nodiscard]] Result<MountCalibration> calibrate_mount(const Board& board, std::span<const BoardPose> poses,
                                                       const cameras::CameraModel& eye, const SE3& T_points_camera,
                                                       const MountTolerance& tolerance = {},
                                                       const MountLimits& limits = {});

}  // namespace cairn::calibration
