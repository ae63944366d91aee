// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "onboard/perception/calibration/lidar_calibration.hpp"
#include "tests/onboard/perception/calibration/boards.hpp"

namespace cairn::calibration::test {

inline constexpr Board kLargeBoard{.columns = 9, .rows = 6, .square_m = 0.08};

inline cameras::CameraParameters robot_camera() {
  return {.width = 672,
          .height = 376,
          .fx = 350,
          .fy = 350,
          .cx = 335.5,
          .cy = 187.5,
          .distortion = {.model = cameras::DistortionModel::kRadTan, .k = {-0.17, 0.026, 0.0004, -0.0003}}};
}

/// T_base_camera of the test's robot; its LiDAR is at the base.
inline SE3 true_mount() { return SE3::from_xyz_rpy((Vector6() << 0.2, 0.05, -0.12, 0.01, 0.03, -0.02).finished()); }

/// What a VLP-16 at the origin sees of a board and of a wall 6 m ahead: several revolutions, noise along the ray. Each
/// revolution begins at another azimuth.
inline Points scan_points(const Board& board, const SE3& T_lidar_board, int revolutions, double noise_m,
                          std::mt19937& random) {
  std::normal_distribution<double> noise(0, noise_m);
  std::uniform_real_distribution<double> phase(0, 0.2);
  const SE3 T = T_lidar_board.inverse();
  const double s = board.square_m;
  Points points;
  for (int turn = 0; turn < revolutions; ++turn) {
    const double offset = phase(random);
    for (int ring = -15; ring <= 15; ring += 2)
      for (int step = -300; step < 300; ++step) {
        const double up = ring * kDegree, aside = (0.2 * step + offset) * kDegree;
        const Eigen::Vector3d ray(std::cos(up) * std::cos(aside), std::cos(up) * std::sin(aside), std::sin(up));
        const Eigen::Vector3d d = T.quaternion() * ray;
        const double range = -T.translation().z() / d.z();
        const Eigen::Vector3d hit = T.translation() + range * d;
        const bool on = range > 0 && hit.x() > -1.7 * s && hit.x() < (board.columns + 0.7) * s && hit.y() > -1.7 * s &&
                        hit.y() < (board.rows + 0.7) * s;
        points.emplace_back(((on ? range : 6 / ray.x()) + noise(random)) * ray);
      }
  }
  return points;
}

/// How boards stand around the robot.
struct Standing {
  double nearest_m = 1.3, farthest_m = 3;
  double tilt = 0.7;  ///< radians, at most, about x and about y of the optical frame
};

/// Poses of the board with corners and the points near it, as they come out of a recording.
inline std::vector<BoardPose> board_poses(std::size_t count, const SE3& T_base_camera, const SE3& believed,
                                          const Standing& how, unsigned seed, double noise_px = 0.1,
                                          double noise_m = 0.01) {
  std::mt19937 random(seed);
  const auto camera = *cameras::CameraModel::create(robot_camera());
  const SE3 T_base_optical = T_base_camera * cameras::T_camera_optical();
  const SE3 T_believed = believed * cameras::T_camera_optical();
  const Holding holding{.nearest = how.nearest_m / kLargeBoard.square_m,
                        .farthest = how.farthest_m / kLargeBoard.square_m,
                        .tilt = how.tilt};
  std::vector<BoardPose> poses;
  while (poses.size() < count) {
    const SE3 T = random_pose(camera, kLargeBoard, holding, random);
    const auto corners = seen_corners(camera, kLargeBoard, T, noise_px, random);
    if (!corners) continue;
    const Points all = scan_points(kLargeBoard, T_base_optical * T, 5, noise_m, random);
    poses.push_back(
        {.corners = *corners, .points = near_board(all, kLargeBoard, T_believed * T, T_believed.translation(), {})});
  }
  return poses;
}

}  // namespace cairn::calibration::test
