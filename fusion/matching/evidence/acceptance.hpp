// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "fusion/matching/evidence/evidence.hpp"

namespace cairn::matching {

/// Settings of decide().
struct AcceptanceConfig {
  double least_probability = 0.95;  ///< of an accepted match
  /// Surface of structure that must agree, m², however large the maps are. Less says nothing. Chosen
  /// by hand, not tuned: 8 % of a floor of offices.
  double least_agreeing_m2 = 25;
  /// Of the structure that meets structure, the share that must agree. A half-turned hall had 0.27.
  /// Right poses that are probable enough have 0.4 and more. Both were measured when structure that
  /// meets a floor counted, too.
  double least_structure_inliers = 0.35;
  /// Below this share, a pose is improbable whatever else speaks for it. Between the two, one look
  /// does not decide, but it counts for PendingHypotheses: of the looks of the fit that lie there and
  /// are probable enough otherwise, 7 of 7 were right, of streets and of maps by stereo cameras.
  double hardly_structure_inliers = 0.25;
  /// Least Evidence::weakest_translation. Below it, no surface holds one direction: an endless
  /// corridor has less than 0.02 (tests/fusion/matching/evidence), a lobby more than 0.05.
  double least_weakest_translation = 0.02;
  /// Least Evidence::agreeing_floor_m2 of an accepted match. Two copies of a furnished room have up to
  /// 77 (rows `copy` of tests/bench/matching_pairs, 76 pairs). So one look at one room never decides.
  double least_floor_m2 = 80;
};

/// The answer to one comparison.
struct Decision {
  bool accepted = false;
  double probability_correct = 0;  ///< within 0.6 m and 6° of the truth
  std::string reason;              ///< why it was accepted or not, for people
};

/// Decides on the evidence of one comparison. It is accepted if it is probably right, enough
/// structure agrees, and each direction is held by some surface.
///
/// The probability is logistic in the floor that agrees, in conflict and in uniqueness; a rival
/// takes its share of it. More floor, less conflict and lesser rivals never make a pose less
/// probable. docs/theory.md has the equation. It was fitted by maximum likelihood to two kinds of
/// looks. Those with a score below 0.03 and those that a setting of AcceptanceConfig excludes were
/// left out.
/// - 400 looks of tests/bench/matching_pairs (seeds below 5000), with voxels of 0.05, 0.1 and 0.2 m:
///   right and wrong ones, other places, and mirror images. Looks at other places weigh as much
///   together as the rest. Mirror images of halls that are symmetric but for their furniture count a
///   tenth: nothing else tells them from the hall after its furniture was moved.
/// - 1 000 looks at growing maps (tests/bench/matching_missions, seeds 100 and 101), at 0.3 of the
///   weight. Wrong ones in half-turned buildings, which nothing gives away, count a fifth of that.
///
/// Structure inliers added nothing to the fit, so they are a bound only. The same holds for how
/// widely conflict is spread. Two things changed after the fit. The score, of which uniqueness is
/// made, leaves out what meets a floor. So does the floor that agrees: maps of two LiDARs have 6 to
/// 14 % less of it. The constant was raised by what 9 % of floor weigh.
///
/// Fits to 27 other places (seeds 198 to 224) were tried: of the constant, of its scale, of all four,
/// and with the voxel size. On places that each fit left out, they accept 3 or 4 of 395 wrong looks,
/// of which these coefficients accept none. So nothing was fitted again.
///
/// Copied geometry can look perfect to any test of one comparison: see PendingHypotheses.
[[nodiscard]] Decision decide(const Evidence& evidence, const AcceptanceConfig& config = {});

}  // namespace cairn::matching
