// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fusion/matching/features/map_voxels.hpp"
#include "fusion/matching/features/nearest_grid.hpp"
#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Settings of what is counted for and against a pose. A change of any of them changes the
/// evidence, on which the probability of decide() was fitted. What is from a prototype was measured
/// there on 13 pairs of maps with the book's 125 starts each.
struct EvidenceConfig {
  // Samples of each map, at most, and the least
  std::size_t surfels = 8000;  ///< for the covariance and the book's test; from a prototype
  /// Surfels of structure, for the score; from a prototype.
  std::size_t structure = 1500;
  /// Surfels of structure on which the evidence of one pose is counted. They are many, because maps
  /// that are large may share a small part. Chosen by hand, not tuned.
  std::size_t weighed = 8000;
  /// Of these, for a first impression; chosen by hand, not tuned.
  std::size_t few = 300;
  std::size_t least_structure = 60;  ///< a map with less is not matched; chosen by hand, not tuned
  // Pairs. A cell is the larger of the two maps' fine cells.
  float pair_cells = 2.5F;   ///< a surfel has a partner within this; chosen by hand, not tuned
  float agree_cells = 1;     ///< a pair within this may agree; from a prototype (0.2 m)
  float same_normal = 0.7F;  ///< least |cosine| between normals that agree; from a prototype
  /// Of the look-up of partners; at least the largest gate of a refinement.
  float reach_cells = 4;
  // Score, in surfels that agree. A prototype found the same modes with 1 to 3 and 0.25 to 0.5.
  double conflict_weight = 2;     ///< of structure in the other map's free space
  double mismatch_weight = 0.25;  ///< of a pair of structure that does not agree
  /// A score falls by this times the share of conflicts, down to least_credit. It came in with
  /// GlobalSearchConfig::best_swept: of 42 pairs without a prior, 38 instead of 30 were found.
  double discredit = 3, least_credit = 0.15;
  /// Share of the source's structure that must agree for a score. Maps that hardly touch contradict
  /// nothing, and would come before the truth where the scene changed or the overlap is small.
  double least_agreeing = 0.01;
};

/// The surfaces of one map, and where it saw free space: what a comparison needs of it.
struct SurfaceModel {
  std::vector<Surfel> surfels;    ///< all, with facing_free_space() applied
  std::vector<Surfel> sample;     ///< of all surfels
  std::vector<Surfel> structure;  ///< sample of the surfels that are structure
  std::vector<Surfel> weighed;    ///< larger sample of these, for the evidence of one pose
  std::vector<Surfel> few;        ///< smaller sample of these, for a first impression
  FreeSpace free;                 ///< the map's
  double cell_m = 0;              ///< edge of a fine cell, m
  double structure_m2 = 0;        ///< surface of all structure, m²: a cell's face for each surfel
};

/// What speaks for and against a pose, counted over samples of both maps.
struct Evidence {
  double overlap = 0;  ///< ε = ½ (N_match/N_s + N_match/N_r) (4.21), 0…1
  /// Share of these pairs with a Mahalanobis distance (3.18, 4.20) below a cell.
  double inlier_ratio = 0;
  /// Of the structure that meets structure, the share that agrees in place and normal.
  double structure_inliers = 0;
  int structure_pairs = 0;  ///< sampled structure of the source that agrees
  /// Surface of the source's structure that agrees, m², from the sample's share.
  double agreeing_m2 = 0;
  /// Source structure in the target's free space, over that plus the structure with a partner, 0…1.
  double conflict = 0;
  /// The same of target structure in the source's free space. Structure there that lies more than a
  /// cell beside its partner counts as well.
  double reverse_conflict = 0;
  /// Floor over which structure agrees, m²: of the source's places in which more agrees than stands
  /// in free space. What meets a floor agrees with nothing: a rough floor fits any other floor.
  /// A place is a column of 1.6 m. So a high wall counts no more than a low one, and a map of fine
  /// voxels no more than one of coarse voxels.
  double agreeing_floor_m2 = 0;
  /// Smallest eigenvalue of the mean n nᵀ (x, y) of what agrees, 0…½.
  double weakest_translation = 0;
  double score = 0;       ///< see score()
  double uniqueness = 1;  ///< 1 − score of the best other place over this one's, 0…1
};

/// Score of a pose, for ranking. Each sampled structure surfel of the source counts:
/// - +1 if it agrees with the target in place, normal and, where known, the side it was seen from,
/// - −mismatch_weight if it meets structure that does not agree,
/// - nothing if it meets a floor or a ceiling: a stereo camera's floor is rough, and partly structure,
/// - −conflict_weight if it stands in the target's free space.
///
/// Target structure in the source's free space counts −conflict_weight, too. The mean over the
/// source's surfels is then discounted by `discredit` for the share of conflicts. Where less than
/// `least_agreeing` agrees, the score is below every other.
[[nodiscard]] double score(const SurfaceModel& target, const NearestGrid& nearest, const SurfaceModel& source,
                           const SE3& T_target_source, const EvidenceConfig& config = {});

/// A rough score() over a few surfels, for ranking hundreds of poses.
[[nodiscard]] double first_impression(const SurfaceModel& target, const NearestGrid& nearest,
                                      const SurfaceModel& source, const SE3& T_target_source,
                                      const EvidenceConfig& config = {});

/// The surfels, with normals of structure turned to the side on which free space was observed,
/// where that is one side only. Two maps that meet back to back at a wall do not agree there.
/// `cell_m`: of the surfels, m.
[[nodiscard]] std::vector<Surfel> facing_free_space(std::span<const Surfel> surfels, const FreeSpace& free,
                                                    float cell_m);

/// A surface model and the look-up of its surfels. Both are the caller's.
struct Indexed {
  const SurfaceModel& model;
  const NearestGrid& nearest;
};

/// The evidence for a pose. Its `uniqueness` is left at 1: that takes other poses.
[[nodiscard]] Evidence weigh(const Indexed& target, const Indexed& source, const SE3& T_target_source,
                             const EvidenceConfig& config = {});

/// Whether two surfels may be of one surface that was seen from one side. `n`: the source's normal
/// in the target's frame. `least_cosine`: see EvidenceConfig::same_normal.
[[nodiscard]] bool same_side(const Surfel& target, const Surfel& source, const Eigen::Vector3f& n, float least_cosine);

/// The book's threshold on the inlier ratio for an overlap ε (4.21): 0.80 below 0.2, 0.9 − ε/2 up
/// to 0.6, then 0.60.
[[nodiscard]] double book_threshold(double overlap);

}  // namespace cairn::matching
