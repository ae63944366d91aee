// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/perception/calibration/board.hpp"

namespace cairn::calibration {

using Points = std::vector<Eigen::Vector3d>;

/// How far the mount of the camera may be off before the calibration.
struct MountTolerance {
  double shift_m = 0.15;
  double turn_deg = 6;
};

/// Points that may be on the board: within its half diagonal and the tolerance of where its middle is expected.
/// `T_points_board`: the expected pose; `eye`: where the camera is, in the frame of the points.
[[nodiscard]] Points near_board(std::span<const Eigen::Vector3d> points, const Board& board, const SE3& T_points_board,
                                const Eigen::Vector3d& eye, const MountTolerance& tolerance);

/// Of such points those on the plane that most of them share and whose normal is within twice the tolerance of the
/// board's. Empty: there is no such plane of at least kLeastPoints. Random with a fixed seed.
[[nodiscard]] Points board_plane(const Points& near, const SE3& T_points_board, const MountTolerance& tolerance);

/// Of such points those within `depth_m` of the squares of a board whose pose is well known.
[[nodiscard]] Points on_squares(const Points& near, const Board& board, const SE3& T_points_board, double depth_m);

inline constexpr std::size_t kLeastPoints = 15;

}  // namespace cairn::calibration
