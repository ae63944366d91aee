// SPDX-License-Identifier: Apache-2.0
// Poses read from any text are finite, ordered in time and unit rotations, and survive being written and read again.
#include <cmath>
#include <string_view>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "drivers/recording/import/kitti_files.hpp"
#include "tests/fuzz/require.hpp"

using namespace cairn;
using namespace cairn::recording;

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::vector<StampedPose> poses, again;
  static_cast<void>(parse_tum(text, "fuzz", poses));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    require(poses[i].pose.translation().allFinite());
    require(std::abs(poses[i].pose.quaternion().norm() - 1.0) < 1e-9);
    require(i == 0 || poses[i].stamp > poses[i - 1].stamp);
  }
  require(parse_tum(to_tum(poses), "written", again).has_value());
  require(again.size() == poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) require(again[i].stamp == poses[i].stamp);

  static_cast<void>(parse_kitti_calibration(text, "fuzz"));
  static_cast<void>(parse_kitti_poses(text, "fuzz"));
  static_cast<void>(parse_kitti_times(text, "fuzz"));
  static_cast<void>(parse_kitti_timestamps(text, "fuzz"));
  return 0;
}
