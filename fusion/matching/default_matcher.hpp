// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/features/nearest_grid.hpp"
#include "fusion/matching/matcher.hpp"
#include "fusion/matching/matcher_config.hpp"
#include "fusion/matching/search/prior_modes.hpp"

namespace cairn::matching {

/// Matches two maps near a prior, or anywhere if gravity is known. The steps are:
/// 1. Search: the poses of the prior's window at which the structure fits best (PriorModes).
///    Without a prior, the best poses at which landmarks meet (constellations()), and those of a
///    sweep over all headings and distances (sweep()), at their heights (stand_up()).
/// 2. Refine each on the coarse surfels, and score it on the fine ones, with free space both ways.
/// 3. Refine the best one on the fine surfels, and weigh the evidence for it.
///
/// The window makes the start irrelevant. Scores keep out poses that overlap more but contradict.
class DefaultMatcher : public Matcher {
 public:
  /// `a` and `b` must outlive the matcher.
  DefaultMatcher(const MapFeatures& a, const MapFeatures& b, const MatcherConfig& config = {});
  [[nodiscard]] Result<MatchResult> match(const std::optional<UncertainPose>& initial, Budget& budget) const override;

  /// The best poses of a search, at most `most`, that are none of the `known` places. Without a
  /// guess the search is everywhere. Empty where a map holds too little.
  [[nodiscard]] std::vector<Look> look_around(const std::optional<UncertainPose>& initial, std::span<const SE3> known,
                                              std::size_t most, Budget& budget) const;
  /// Whether both maps hold enough structure.
  [[nodiscard]] bool comparable() const { return !judge_.without_search({}); }
  /// Weighs a pose as it is.
  [[nodiscard]] Look look(const SE3& T_a_b) const { return judge_.look(T_a_b, anywhere().covariance); }
  /// Refines a known pose on the maps as they are now, and weighs it. The pose stays as it was if
  /// refinement leads to another place or to a pose that leans.
  [[nodiscard]] Look look_again(const SE3& known, Budget& budget) const;

 private:
  struct Candidate {
    SE3 T_a_b;
    double score;
  };
  /// The candidates of a search, best first. Without a guess, none that leans.
  [[nodiscard]] std::vector<Candidate> modes(const std::optional<UncertainPose>& initial, Budget& budget) const;
  /// Starts for refinement without a prior.
  [[nodiscard]] std::vector<SE3> starts_anywhere(Budget& budget) const;
  /// Poses without a prior, at their heights, each list best first. Both maps are straightened first.
  struct Proposals {
    std::vector<SE3> of_landmarks;  ///< see constellations()
    std::vector<SE3> swept;         ///< see sweep()
  };
  [[nodiscard]] Proposals proposed(Budget& budget) const;
  /// The most promising of the poses, each after a short climb, best first.
  [[nodiscard]] std::vector<Candidate> climbed(const std::vector<SE3>& poses, Budget& budget) const;
  /// Refines each start on the coarse surfels and scores it, best first. Starts that soon lead the
  /// same way give one candidate.
  [[nodiscard]] std::vector<Candidate> verified(const std::vector<SE3>& starts, Budget& budget) const;
  /// Refines the first few on the fine surfels and scores them again, best first.
  void look_closer(std::vector<Candidate>& best_first, Budget& budget) const;
  [[nodiscard]] SE3 on_coarse(const SE3& T, const RefinementStage& stage, Budget& budget) const;
  [[nodiscard]] SE3 on_fine(const SE3& T, const RefinementStage& stage, Budget& budget) const;
  /// Whether a pose leans more than gravity allows, after straightening.
  [[nodiscard]] bool leans(const SE3& T) const;

  MatcherConfig config_;
  const mapping::SemanticOcTree& map_a_;
  const mapping::SemanticOcTree& map_b_;
  Judge judge_;
  PriorModes modes_;
  std::span<const Surfel> coarse_a_;
  std::vector<Surfel> coarse_sample_b_, climbing_sample_b_;
  SE3 T_level_a_, T_level_b_;
  float coarse_m_;
  NearestGrid near_coarse_;
};

/// DefaultMatcher without a prior: it does not use a guess. A guess that is not valid is an error
/// all the same.
class GlobalMatcher final : public DefaultMatcher {
 public:
  using DefaultMatcher::DefaultMatcher;
  [[nodiscard]] Result<MatchResult> match(const std::optional<UncertainPose>& initial, Budget& budget) const override;
};

}  // namespace cairn::matching
