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

/// A line of answers.csv: what a detector said of a body.
struct AnswerRow {
  Time stamp{};  ///< of the scan
  bool thermal = false;
  Eigen::Vector2d position{0, 0};  ///< of the body, odom, metres
  double ground = 0;               ///< z below
  bool boxed = false;              ///< a box of a person belongs to it
  double score = 0;                ///< of the box
  double distance_m = 0;           ///< along the view
};

inline constexpr std::uint64_t kMaxAnswerBytes = 512U << 20U;

/// Reads answers.csv of a run. The first line is `t,camera,x,y,z,verdict,score,distance_m`. Times, in seconds on the
/// recording's time line, may come in any order. Errors name file and line.
[[nodiscard]] Result<std::vector<AnswerRow>> parse_answers(std::string_view text, std::string_view name);
/// The whole file. Errors: those of parse_answers(), and those of reading.
[[nodiscard]] Result<std::vector<AnswerRow>> read_answers(const std::filesystem::path& file);

}  // namespace cairn::cli
