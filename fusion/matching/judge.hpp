// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fusion/matching/evidence.hpp"
#include "fusion/matching/matcher.hpp"
#include "fusion/matching/nearest_grid.hpp"

namespace cairn::matching {

/// Says of any pose of one pair of maps what speaks for it, whoever found it.
class Judge {
 public:
  /// `a` and `b` must outlive the judge.
  Judge(const MapFeatures& a, const MapFeatures& b);

  [[nodiscard]] const Party& a() const { return a_; }
  [[nodiscard]] const Party& b() const { return b_; }
  [[nodiscard]] const NearestGrid& near_a() const { return near_a_; }
  [[nodiscard]] float cell_m() const { return cell_m_; }
  /// Why these maps cannot be matched at all; none if they can.
  [[nodiscard]] std::optional<std::string> hopeless() const;

  /// For ranking; see score().
  [[nodiscard]] double score(const SE3& T_a_b) const { return matching::score(a_, near_a_, b_, T_a_b); }
  /// The result for a pose: covariance, evidence, the book's test and the decision.
  [[nodiscard]] MatchResult conclude(const SE3& T_a_b, const Matrix6& prior_covariance, double uniqueness,
                                     const Budget& budget) const;

 private:
  Party a_, b_;
  float cell_m_;
  NearestGrid near_a_;
};

/// Those of the surfels that are structure.
[[nodiscard]] std::vector<Surfel> structure_of(std::span<const Surfel> surfels);
/// The error match() gives for a guess it cannot use; none if it can.
[[nodiscard]] std::optional<Error> fault_of(const std::optional<UncertainPose>& initial);
/// What a match without a guess starts from: ±10 m, all headings.
[[nodiscard]] UncertainPose anywhere();

}  // namespace cairn::matching
