// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "fusion/matching/coarse_search.hpp"
#include "fusion/matching/judge.hpp"
#include "fusion/matching/matcher.hpp"
#include "fusion/matching/nearest_grid.hpp"
#include "fusion/matching/refine.hpp"

namespace cairn::matching {

/// Coarse correlation over the prior's window → several modes → each refined on the coarse surfels → verified on the
/// fine map with free space both ways → the best one refined on the fine surfels. The window makes the start
/// irrelevant, the modes and the free space keep out what merely overlaps more.
class DefaultMatcher final : public Matcher {
 public:
  /// `a` and `b` must outlive the matcher.
  DefaultMatcher(const MapFeatures& a, const MapFeatures& b);
  [[nodiscard]] Result<MatchResult> match(const std::optional<UncertainPose>& initial, Budget& budget) const override;

 private:
  struct Candidate {
    SE3 T_a_b;
    double score;
  };
  [[nodiscard]] std::vector<Candidate> verified_modes(const SE3& initial, const SearchWindow& window, int modes,
                                                      Budget& budget) const;

  Judge judge_;
  std::vector<Eigen::Vector3f> structure_a_, structure_b_;  // coarse
  std::span<const Surfel> coarse_a_;
  std::vector<Surfel> coarse_sample_b_;
  float coarse_m_;
  NearestGrid near_coarse_;
};

}  // namespace cairn::matching
