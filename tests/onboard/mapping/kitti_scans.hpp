// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "tests/onboard/mapping/scan_yard.hpp"
#include "tests/support/recorded_data.hpp"

namespace cairn::mapping {

inline std::filesystem::path kitti_recording() { return support::recorded_data("kitti/odometry00"); }

/// One line of a KITTI pose or calibration file: twelve numbers, the upper part of a 4×4 matrix in row order.
inline bool read_kitti_matrix(std::istream& in, Eigen::Isometry3d& T) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) in >> T.matrix()(row, column);
  T.matrix().row(3) << 0, 0, 0, 1;
  return static_cast<bool>(in);
}

/// At most `count` scans of KITTI odometry 00 (HDL-64E, motion-compensated) in the map frame, which is the first scan's
/// frame, of which every `stride`-th point; empty when the recording is not there.
inline std::vector<MapScan> kitti_scans(int count, int stride) {
  const std::filesystem::path folder = kitti_recording();
  std::ifstream poses(folder / "poses_cam0.txt"), calibration(folder / "calib.txt");
  std::string word;
  while (calibration >> word && word != "Tr:") calibration.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  Eigen::Isometry3d T_cam_lidar, T_map_cam;
  if (!read_kitti_matrix(calibration, T_cam_lidar)) return {};
  std::vector<MapScan> scans;
  for (int i = 0; i < count && read_kitti_matrix(poses, T_map_cam); ++i) {
    const std::string name = std::string(6 - std::to_string(i).size(), '0') + std::to_string(i) + ".bin";
    std::ifstream in(folder / "velodyne" / name, std::ios::binary);
    // The first LiDAR frame is the map frame: upright, where the camera's lies on its side.
    const Eigen::Isometry3d T_map_lidar = T_cam_lidar.inverse() * T_map_cam * T_cam_lidar;
    MapScan scan{{}, T_map_lidar.translation().cast<float>()};
    int point = 0;
    for (float xyzi[4]; in.read(reinterpret_cast<char*>(xyzi), sizeof xyzi);)
      if (point++ % stride == 0)
        scan.points.emplace_back((T_map_lidar * Eigen::Vector3d(xyzi[0], xyzi[1], xyzi[2])).cast<float>());
    scans.push_back(std::move(scan));
  }
  return scans;
}
/// With every point.
inline std::vector<MapScan> kitti_scans(int count) { return kitti_scans(count, 1); }

}  // namespace cairn::mapping
