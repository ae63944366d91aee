// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion/matching/evidence/acceptance.hpp"
#include "fusion/matching/evidence/evidence.hpp"
#include "fusion/matching/evidence/match_result.hpp"
#include "fusion/matching/features/map_features.hpp"
#include "fusion/matching/features/nearest_grid.hpp"
#include "fusion/matching/search/same_place.hpp"
#include "hal/budget.hpp"
#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// One comparison of two maps at one pose.
struct Look {
  UncertainPose T_a_b;
  Evidence evidence;
};

/// Weighs any pose of one pair of maps. It does not matter how the pose was found.
class Judge {
 public:
  /// `a` and `b` must outlive the judge.
  Judge(const MapFeatures& a, const MapFeatures& b, const EvidenceConfig& evidence = {},
        const AcceptanceConfig& acceptance = {});

  [[nodiscard]] const SurfaceModel& a() const { return a_; }
  [[nodiscard]] const SurfaceModel& b() const { return b_; }
  /// The look-up of a's fine surfels.
  [[nodiscard]] const NearestGrid& near_a() const { return near_a_; }
  /// Edge of the larger of the two maps' fine cells, m.
  [[nodiscard]] float cell_m() const { return cell_m_; }
  /// The answer where nothing can be searched; empty if there is something to search. It is an
  /// error for a guess that cannot be used, and a refusal with its reason for maps that hold too
  /// little.
  [[nodiscard]] std::optional<Result<MatchResult>> without_search(const std::optional<UncertainPose>& initial) const;

  /// For ranking; see matching::score().
  [[nodiscard]] double score(const SE3& T_a_b) const { return matching::score(a_, near_a_, b_, T_a_b, config_); }
  /// For ranking many; see matching::first_impression().
  [[nodiscard]] double first_impression(const SE3& T_a_b) const {
    return matching::first_impression(a_, near_a_, b_, T_a_b, config_);
  }
  /// Covariance and evidence of a pose. Its uniqueness is left at 1.
  [[nodiscard]] Look look(const SE3& T_a_b, const Matrix6& prior_covariance) const;
  /// The result for a pose: covariance, evidence, the book's test and decide()'s.
  [[nodiscard]] MatchResult conclude(const SE3& T_a_b, const Matrix6& prior_covariance, double uniqueness,
                                     const Budget& budget) const;

 private:
  EvidenceConfig config_;
  AcceptanceConfig acceptance_;
  SurfaceModel a_, b_;
  float cell_m_;
  NearestGrid near_a_, near_b_;
};

/// A map's surfels with facing_free_space() applied, and samples of them. Looks into the map's
/// tree.
[[nodiscard]] SurfaceModel surface_model_of(const MapFeatures& map, const EvidenceConfig& config = {});
/// The error for a guess that cannot be used (kInvalidConfig); empty if it can.
[[nodiscard]] std::optional<Error> fault_of(const std::optional<UncertainPose>& initial);
/// A result without evidence: the prior, and the reason for which nothing better is known.
[[nodiscard]] MatchResult refused(const UncertainPose& prior, std::string reason);
/// The prior of a search without a guess: the direction of gravity is known, place and heading are
/// not.
[[nodiscard]] UncertainPose anywhere();

}  // namespace cairn::matching
