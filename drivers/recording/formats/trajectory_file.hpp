// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::recording {

/// One pose of a trajectory, such as T_odom_base or T_map_base.
struct StampedPose {
  Time stamp{};
  SE3 pose;
};

/// Reads the TUM format, one pose a line: `t tx ty tz qx qy qz qw`, seconds, metres, unit quaternion; `#` starts a
/// comment line. Stamps must increase. (https://cvg.cit.tum.de/data/datasets/rgbd-dataset/file_formats)
/// Poses before a fault are kept in `poses`; the Error says "name: cause: line 12: …" with the byte offset of the line.
[[nodiscard]] Result<void> parse_tum(std::string_view text, std::string_view name, std::vector<StampedPose>& poses);

/// The whole file, or an Error.
[[nodiscard]] Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path);

/// Nine decimals for the time (exact nanoseconds), twelve significant digits elsewhere, qw ≥ 0: same poses, same bytes.
[[nodiscard]] std::string to_tum(std::span<const StampedPose> poses);
/// Writes the file atomically.
[[nodiscard]] Result<void> write_tum(const std::filesystem::path& path, std::span<const StampedPose> poses);

inline constexpr std::uint64_t kMaxTrajectoryBytes = 256U << 20U;

}  // namespace cairn::recording
