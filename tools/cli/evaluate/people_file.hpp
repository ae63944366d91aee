// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace cairn::cli {

/// A line of people.csv: where somebody was at an instant.
struct PersonRow {
  Time stamp{};
  std::int64_t id = 0;
  Eigen::Vector2d position{0, 0};  ///< metres, in the file's frame
  double ground = 0;               ///< z below; 0 in files without the column z
};

inline constexpr std::uint64_t kMaxPeopleBytes = 256U << 20U;
inline constexpr double kFarthest_m = 1e6;                             ///< of a position in these files
inline constexpr std::int64_t kLatest_ns = 4'000'000'000'000'000'000;  ///< so that differences are numbers, too

/// Reads people.csv of a run (in odom) or of a simulation (in the world). The first line names the columns, which begin
/// with `t,id,x,y`; of further columns only `z` is read. Times, in seconds on the recording's time line, do not
/// decrease, and an id occurs once at a time. Errors name file and line.
[[nodiscard]] Result<std::vector<PersonRow>> parse_people(std::string_view text, std::string_view name);
/// The whole file. Errors: those of parse_people(), and those of reading.
[[nodiscard]] Result<std::vector<PersonRow>> read_people(const std::filesystem::path& file);

}  // namespace cairn::cli
