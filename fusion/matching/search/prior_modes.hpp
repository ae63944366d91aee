// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "fusion/matching/features/map_features.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Settings of the search near a prior. What is from a prototype was measured there on 13 pairs of
/// maps with the book's 125 starts each.
struct CoarseSearchConfig {
  std::size_t points = 2000;  ///< of b's structure, at most; from a prototype
  /// Edge of a cell, m, unless a map's coarse cells are larger; from a prototype.
  float cell_m = 0.4F;
  /// Poses that are refined. 60 instead of 40: an office at 10 to 21 % overlap went from 86-88 to
  /// 95-98 % success (tools/protocol.sh). 40 instead of 16: every start of halves of the recorded
  /// maps that share 20 and 25 % succeeded (tests/bench/matching_protocol).
  int modes = 60;
  /// The same, in a window wider than wide_yaw_rad; chosen by hand, not tuned.
  int wide_modes = 48;
  double wide_yaw_rad = 1.0;  ///< half width of the heading, rad; chosen by hand, not tuned
  /// The window is so many of the prior's standard deviations wide, to either side: 99.7 %.
  double sigmas = 3;
  double least_xy_m = 0.8;  ///< half width, at least, m: two cells
  /// Half width, at most, m: a bound on time; GlobalMatcher goes further.
  double most_xy_m = 20;
  double most_z_m = 4;          ///< half width of the height, at most, m: a storey
  double least_yaw_rad = 0.07;  ///< half width of the heading, at least, rad: 4°
  /// If the height's standard deviation is below this (m), the search has one height. A prototype
  /// with starts off by 0.5 m succeeded 64 times of 64 with and without a search over the height.
  double one_height_m = 0.5;
  /// A result may leave the window by this: a cell of the search, and what that is at 4 m (rad).
  /// With this bound, a corridor at 16 to 36 % overlap went from 58-65 to 91-92 % success.
  double margin_m = 0.4, margin_rad = 0.1;
};

/// Poses within a prior's window at which the structure of two maps fits best. They are so many
/// that the result does not depend on where in the window the prior's mean is.
class PriorModes {
 public:
  /// Copies what it needs of the two maps.
  PriorModes(const MapFeatures& a, const MapFeatures& b, const CoarseSearchConfig& config = {});

  /// Poses T_a_b within the prior's window, best first, by correlation of the coarse structure; see
  /// search(). At least one.
  [[nodiscard]] std::vector<SE3> near(const UncertainPose& prior) const;

 private:
  CoarseSearchConfig config_;
  std::vector<Eigen::Vector3f> structure_a_, structure_b_;
  float cell_m_;
};

/// Whether a refined pose is still inside the prior's window, by the margin. Refinement may lead to
/// the next door of a corridor, which often fits as well.
[[nodiscard]] bool within(const UncertainPose& prior, const SE3& T_a_b, const CoarseSearchConfig& config = {});

}  // namespace cairn::matching
