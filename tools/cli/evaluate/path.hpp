// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "drivers/recording/formats/trajectory_file.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::cli {

/// Where a robot was at any time: the poses of a TUM file.
class Path {
 public:
  /// Errors: those of the file; kMalformed where it has no pose.
  [[nodiscard]] static Result<Path> read(const std::filesystem::path& file);
  /// `poses`: at least one, in the order of time.
  explicit Path(std::vector<recording::StampedPose> poses) : poses_(std::move(poses)) {}

  /// The pose at `t`, on the screw motion between the poses around it. Before the first pose it is the first one,
  /// after the last pose the last one.
  [[nodiscard]] SE3 at(Time t) const;
  /// Whether a pose is at most `apart` before or after `t`.
  [[nodiscard]] bool has_pose_near(Time t, Duration apart) const;
  /// The same path in another frame.
  [[nodiscard]] Path moved(const SE3& T_to_from) const;
  [[nodiscard]] const std::vector<recording::StampedPose>& poses() const { return poses_; }

 private:
  std::vector<recording::StampedPose> poses_;
};

}  // namespace cairn::cli
