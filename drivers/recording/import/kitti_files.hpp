// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

// The text files of the KITTI data sets.
namespace cairn::recording {

/// `Tr` of a calib.txt: T_cam0_velodyne, twelve numbers, row major 3×4. Error kNotFound when there is no such line.
[[nodiscard]] Result<SE3> parse_kitti_calibration(std::string_view text, std::string_view name);
/// One pose T_first_cam0 a line, twelve numbers, row major 3×4.
[[nodiscard]] Result<std::vector<SE3>> parse_kitti_poses(std::string_view text, std::string_view name);
/// times.txt: seconds since the first sweep, one a line.
[[nodiscard]] Result<std::vector<Time>> parse_kitti_times(std::string_view text, std::string_view name);
/// timestamps.txt of KITTI raw: `2011-09-26 13:02:25.594360375`, UTC, one a line.
[[nodiscard]] Result<std::vector<Time>> parse_kitti_timestamps(std::string_view text, std::string_view name);

/// Reads a text file of at most 64 MiB and hands it to one of the functions above.
template <class T>
[[nodiscard]] Result<T> read_kitti(const std::filesystem::path& path,
                                   Result<T> (*parse)(std::string_view, std::string_view));

/// The regular files of `folder` with this extension, sorted by name (numbers by their value). Error when the folder
/// cannot be read or has none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> sorted_files(const std::filesystem::path& folder,
                                                                      std::string_view extension);
/// A text file of at most 64 MiB. Errors: kNotFound, kIo, kLimit.
[[nodiscard]] Result<std::string> read_text(const std::filesystem::path& path);

template <class T>
Result<T> read_kitti(const std::filesystem::path& path, Result<T> (*parse)(std::string_view, std::string_view)) {
  const auto text = read_text(path);
  if (!text) return text.error();
  return parse(*text, path.string());
}

}  // namespace cairn::recording
