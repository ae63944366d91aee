// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fusion/matching/evidence/match_result.hpp"
#include "tests/bench/pairs/chart.hpp"

namespace cairn::pairs {

// What is measured, not tuned.
inline constexpr std::array kVoxels_m{0.1, 0.2, 0.05};
inline constexpr std::array kMoved_m{0.0, 0.5, 1.2};
inline constexpr std::array kKindNames{"rooms", "hall", "outdoor"};

/// One pair of maps and what the matcher said. `type`: global, local, plain, mirrored, symmetric (mirrored, of a hall
/// that is symmetric but for its furniture), copy or turned.
struct Answer {
  std::string type, kind;
  double voxel_m = 0, moved_m = 0, lean_deg = 0, dz_m = 0, overlap = 0, ms = 0;
  bool right = false;
  matching::MatchResult result;
};

/// What memory is in use now, and at most since the last call, MB (of Linux).
[[nodiscard]] std::array<double, 2> memory_mb();

/// All answers, and what they add up to.
class Results {
 public:
  explicit Results(bool csv);
  /// Matches, and keeps the answer. `about`: what is known before.
  void match(Answer about, const Chart& a, const Chart& b, const std::optional<UncertainPose>& initial,
             std::uint64_t seed);
  void print() const;

 private:
  template <class Which>
  void row(const std::string& name, const Which& which) const;
  void calibrated(double voxel_m) const;

  bool csv_;
  std::vector<Answer> all_;
};

}  // namespace cairn::pairs
