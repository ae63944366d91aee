// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion/matching/evidence/evidence.hpp"
#include "fusion/matching/evidence/match_result.hpp"
#include "fusion/matching/features/map_features.hpp"
#include "fusion/matching/features/nearest_grid.hpp"
#include "hal/budget.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// One comparison of two maps at one pose.
struct Look {
  UncertainPose T_a_b;
  Evidence evidence;
};

/// Says of any pose of one pair of maps what speaks for it, whoever found it.
class Judge {
 public:
  /// `a` and `b` must outlive the judge.
  Judge(const MapFeatures& a, const MapFeatures& b);

  [[nodiscard]] const Party& a() const { return a_; }
  [[nodiscard]] const Party& b() const { return b_; }
  [[nodiscard]] const NearestGrid& near_a() const { return near_a_; }
  [[nodiscard]] float cell_m() const { return cell_m_; }
  /// The answer to a guess that cannot be used (an error) and to maps that cannot be matched at all (refused, with the
  /// reason); none if there is something to search.
  [[nodiscard]] std::optional<Result<MatchResult>> without_search(const std::optional<UncertainPose>& initial) const;

  /// For ranking; see score().
  [[nodiscard]] double score(const SE3& T_a_b) const { return matching::score(a_, near_a_, b_, T_a_b); }
  /// The same, roughly.
  [[nodiscard]] double first_impression(const SE3& T_a_b) const {
    return matching::first_impression(a_, near_a_, b_, T_a_b);
  }
  /// Covariance and evidence of a pose; its uniqueness is left open.
  [[nodiscard]] Look look(const SE3& T_a_b, const Matrix6& prior_covariance) const;
  /// The result for a pose: covariance, evidence, the book's test and the decision.
  [[nodiscard]] MatchResult conclude(const SE3& T_a_b, const Matrix6& prior_covariance, double uniqueness,
                                     const Budget& budget) const;

 private:
  Party a_, b_;
  float cell_m_;
  NearestGrid near_a_, near_b_;
};

/// A map's surfels facing free space, and samples of them.
[[nodiscard]] Party party_of(const MapFeatures& map);
/// The error for a guess that cannot be used; none if it can.
[[nodiscard]] std::optional<Error> fault_of(const std::optional<UncertainPose>& initial);
/// A result without evidence: the prior, and why nothing better is known.
[[nodiscard]] MatchResult refused(const UncertainPose& prior, std::string reason);
/// Whether two poses are one place, found twice: less than 0.8 m and 4° apart.
[[nodiscard]] bool same_place(const SE3& T, const SE3& other);
/// What is known without a guess: which way is up.
[[nodiscard]] UncertainPose anywhere();

}  // namespace cairn::matching
