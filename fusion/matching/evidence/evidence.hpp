// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fusion/matching/features/map_voxels.hpp"
#include "fusion/matching/features/nearest_grid.hpp"
#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// One map as a party to a comparison: surfels, those of them that are structure (a sample), and what it saw free.
struct Party {
  std::vector<Surfel> surfels;    ///< structure faces free space
  std::vector<Surfel> sample;     ///< of all surfels
  std::vector<Surfel> structure;  ///< of those that are structure
  std::vector<Surfel> few;        ///< of these, for a first impression
  FreeSpace free;
  double cell_m;
  double structure_m2 = 0;  ///< what all of the structure covers, a cell's face for each surfel
};

/// What speaks for and against a pose, counted over samples of both maps.
struct Evidence {
  double overlap = 0;              ///< ε = ½ (N_match/N_s + N_match/N_r) (4.21), pairs within 2.5 cells
  double inlier_ratio = 0;         ///< of these pairs, those with a Mahalanobis distance (3.18, 4.20) below one cell
  double structure_inliers = 0;    ///< of the structure that has a partner, what agrees in place and normal
  int structure_pairs = 0;         ///< that agree
  double agreeing_m2 = 0;          ///< surface of all the source's structure that agrees, from the sample's share
  double conflict = 0;             ///< source structure in space the target saw free, over that plus what has a partner
  double reverse_conflict = 0;     ///< the same of target structure, and of what is beside its partner by over a cell
  double weakest_translation = 0;  ///< smallest eigenvalue of the mean n nᵀ (x, y) over agreeing structure, 0…½
  double score = 0;                ///< see score()
  double uniqueness = 1;           ///< 1 − score of the best other mode over this one's, 0…1
};

/// Score of a pose for ranking modes: +1 for each structure surfel of the source that agrees in place, normal and,
/// where known, the side it was seen from,
/// −¼ where it meets another surface, −2 where it stands in the target's free space, and −2 for target structure in
/// the source's free space; per source surfel, and times 1 − 3·(share of conflicts), at least 0.15.
[[nodiscard]] double score(const Party& target, const NearestGrid& nearest, const Party& source,
                           const SE3& T_target_source);

/// A rough score() over a few surfels, for sorting out hundreds of poses.
[[nodiscard]] double first_impression(const Party& target, const NearestGrid& nearest, const Party& source,
                                      const SE3& T_target_source);

/// The surfels with the normals of structure turned to where free space was observed on one side only: two maps that
/// meet back to back at a wall must not agree there.
[[nodiscard]] std::vector<Surfel> facing_free_space(std::span<const Surfel> surfels, const FreeSpace& free,
                                                    float cell_m);

/// A party, and what is nearest to any place in it.
struct Indexed {
  const Party& party;
  const NearestGrid& nearest;
};

/// Leaves `uniqueness` alone.
[[nodiscard]] Evidence weigh(const Indexed& target, const Indexed& source, const SE3& T_target_source);

/// Whether two surfels may be of one surface seen from one side; `n`: the source's normal in the target's frame.
[[nodiscard]] bool same_side(const Surfel& target, const Surfel& source, const Eigen::Vector3f& n);

/// The book's threshold on the inlier ratio for an overlap (4.21): 0.80 below 0.2, 0.9 − ε/2 up to 0.6, then 0.60.
[[nodiscard]] double book_threshold(double overlap);

}  // namespace cairn::matching
