// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "onboard/odometry/config.hpp"
#include "onboard/odometry/estimation/motion_filter.hpp"

namespace cairn::odometry {

/// Finds the start hypothesis of a registration. As a rule that is the prediction. Where the
/// prediction says little, hypotheses around it are compared by how many keypoints fit:
///   - forward speeds, for the first scans of a map whose speed is unknown;
///   - headings and positions, for a robot that was restarted (see search_after_gap()).
class StartSearch {
 public:
  /// How many keypoints fit a hypothesis, within a gate in metres. Larger is better.
  using Score = std::function<double(const MotionState& hypothesis, double gate_m)>;

  explicit StartSearch(const OdometryConfig& config);

  /// A new map begins: its next scans may guess the speed.
  void begin_map();

  /// `filter` holds the prediction over the last `dt_s` seconds (> 0).
  [[nodiscard]] MotionState find(const MotionFilter& filter, double dt_s, const Score& score);
  /// The same for the first scan after a restart.
  [[nodiscard]] MotionState find_restarted(const MotionFilter& filter, double dt_s, const Score& score) const;

 private:
  [[nodiscard]] MotionState guess_speed(const MotionState& predicted, double dt_s, const Score& score) const;

  StartSearchConfig config_;
  double fastest_m_s_;
  int speed_guesses_left_ = 0;
};

}  // namespace cairn::odometry
