// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>

#include "hal/point_cloud.hpp"

namespace cairn::support {

/// A sweep in KITTI's odometry layout: 10 Hz, already motion-compensated. Nothing where there is no such file.
inline std::optional<Scan> kitti_sweep(const std::filesystem::path& sequence, int index) {
  std::array<char, 16> name{};
  std::snprintf(name.data(), name.size(), "%06d.bin", index);
  std::ifstream in(sequence / "velodyne" / name.data(), std::ios::binary);
  if (!in) return std::nullopt;
  Scan scan;
  scan.valid = {Time{from_seconds(0.1 * index)}, Time{from_seconds(0.1 * (index + 1))}};
  scan.deskewed = true;
  std::array<float, 4> xyzi{};
  while (in.read(reinterpret_cast<char*>(xyzi.data()), sizeof xyzi))
    scan.cloud.push_back({xyzi[0], xyzi[1], xyzi[2]}, 255 * xyzi[3], 0, 0, ReturnType::kStrongest);
  return scan;
}

}  // namespace cairn::support
