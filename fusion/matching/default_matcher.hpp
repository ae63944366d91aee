// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/features/nearest_grid.hpp"
#include "fusion/matching/matcher.hpp"
#include "fusion/matching/search/prior_modes.hpp"
#include "fusion/matching/search/refine.hpp"

namespace cairn::matching {

/// Coarse correlation over the prior's window → several modes → each refined on the coarse surfels → verified on the
/// fine map with free space both ways → the best one refined on the fine surfels. The window makes the start
/// irrelevant, the modes and the free space keep out what merely overlaps more. Without a prior the modes are those of
/// a sweep over all headings and distances with gravity known (GlobalMatcher), hundreds of them, of which a first
/// impression leaves the best.
class DefaultMatcher : public Matcher {
 public:
  /// `a` and `b` must outlive the matcher.
  DefaultMatcher(const MapFeatures& a, const MapFeatures& b);
  [[nodiscard]] Result<MatchResult> match(const std::optional<UncertainPose>& initial, Budget& budget) const override;

  /// The best poses of a search, at most `most`, none of which is one of the `known` places; without a guess
  /// everywhere. None where a map holds too little.
  [[nodiscard]] std::vector<Look> look_around(const std::optional<UncertainPose>& initial, std::span<const SE3> known,
                                              std::size_t most, Budget& budget) const;
  /// Whether both maps hold enough structure for any look.
  [[nodiscard]] bool comparable() const { return !judge_.without_search({}); }
  /// A pose as it is.
  [[nodiscard]] Look look(const SE3& T_a_b) const { return judge_.look(T_a_b, anywhere().covariance); }
  /// A pose that was known before, refined on what the maps hold now; as it was, where that leads to another place, or
  /// to one that leans.
  [[nodiscard]] Look look_again(const SE3& known, Budget& budget) const;

 private:
  struct Candidate {
    SE3 T_a_b;
    double score;
  };
  /// What a search finds, best first; without a guess, nothing that leans more than anywhere() allows.
  [[nodiscard]] std::vector<Candidate> modes(const std::optional<UncertainPose>& initial, Budget& budget) const;
  [[nodiscard]] SE3 refined(const SE3& T, Budget& budget) const;
  [[nodiscard]] std::vector<SE3> starts_anywhere(Budget& budget) const;
  [[nodiscard]] SE3 on_coarse(const SE3& T, const RefineOptions& in_cells, Budget& budget) const;
  /// Each start refined on the coarse surfels and scored, best first; one for all that soon go the same way.
  [[nodiscard]] std::vector<Candidate> verified(const std::vector<SE3>& starts, Budget& budget) const;
  /// The first few of them refined on the fine surfels and scored again, best first.
  void look_closer(std::vector<Candidate>& best_first, Budget& budget) const;

  const SemanticOcTree& map_a_;
  const SemanticOcTree& map_b_;
  Judge judge_;
  PriorModes modes_;
  std::span<const Surfel> coarse_a_;
  std::vector<Surfel> coarse_sample_b_;
  float coarse_m_;
  NearestGrid near_coarse_;
};

/// Never believes a guess; one that cannot be used is an error all the same.
class GlobalMatcher final : public DefaultMatcher {
 public:
  using DefaultMatcher::DefaultMatcher;
  [[nodiscard]] Result<MatchResult> match(const std::optional<UncertainPose>& initial, Budget& budget) const override;
};

}  // namespace cairn::matching
