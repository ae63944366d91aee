// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/judge.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fusion/matching/evidence/acceptance.hpp"
#include "fusion/matching/evidence/match_covariance.hpp"
#include "fusion/matching/features/sample.hpp"
#include "fusion/matching/features/structure.hpp"

namespace cairn::matching {
namespace {

constexpr std::size_t kFinePoints = 8000, kVerifyPoints = 1500, kFewPoints = 300, kMinStructure = 60;
constexpr float kNearCells = 4;
constexpr double kSameM = 0.8, kSameRad = 0.07;

}  // namespace

bool same_place(const SE3& T, const SE3& other) {
  const SE3 between = T.inverse() * other;
  return between.translation().norm() < kSameM && rotation_angle(between) < kSameRad;
}

UncertainPose anywhere() {
  UncertainPose pose;
  Vector6 sigma;
  sigma << 100, 100, 3, 0.03, 0.03, M_PI;
  pose.covariance = sigma.cwiseAbs2().asDiagonal();
  return pose;
}

Judge::Judge(const MapFeatures& a, const MapFeatures& b)
    : a_(party_of(a)),
      b_(party_of(b)),
      cell_m_(std::max(a.fine_m(), b.fine_m())),
      near_a_(a.fine(), cell_m_, kNearCells * cell_m_),
      near_b_(b.fine(), cell_m_, kNearCells * cell_m_) {}

Party party_of(const MapFeatures& map) {
  Party party{{}, {}, {}, {}, FreeSpace(map.map()), static_cast<double>(map.fine_m()), 0};
  party.surfels = facing_free_space(map.fine(), party.free, map.fine_m());
  const auto structure = structure_of(party.surfels);
  party.structure_m2 = static_cast<double>(structure.size()) * party.cell_m * party.cell_m;
  party.sample = sample(std::span<const Surfel>(party.surfels), kFinePoints);
  party.structure = sample(std::span<const Surfel>(structure), kVerifyPoints);
  party.few = sample(std::span<const Surfel>(structure), kFewPoints);
  return party;
}

std::optional<Error> fault_of(const std::optional<UncertainPose>& initial) {
  if (!initial) return std::nullopt;
  if (!initial->mean.matrix().allFinite() || !initial->covariance.allFinite())
    return Error{Errc::kInvalidConfig, "the initial pose is not finite", "initial pose"};
  if (Eigen::SelfAdjointEigenSolver<Matrix6>(initial->covariance).eigenvalues()[0] <= 0)
    return Error{Errc::kInvalidConfig, "the initial covariance is not positive definite", "initial pose"};
  return std::nullopt;
}

MatchResult refused(const UncertainPose& prior, std::string reason) {
  MatchResult result;
  result.T_a_b = prior;
  result.reason = std::move(reason);
  return result;
}

std::optional<Result<MatchResult>> Judge::without_search(const std::optional<UncertainPose>& initial) const {
  if (auto fault = fault_of(initial)) return *std::move(fault);
  const UncertainPose prior = initial.value_or(anywhere());
  if (a_.structure.size() < kMinStructure) return refused(prior, "map a holds too little structure");
  if (b_.structure.size() < kMinStructure) return refused(prior, "map b holds too little structure");
  return std::nullopt;
}

Look Judge::look(const SE3& T_a_b, const Matrix6& prior_covariance) const {
  return {{T_a_b, covariance(a_, near_a_, b_, T_a_b, prior_covariance)}, weigh({a_, near_a_}, {b_, near_b_}, T_a_b)};
}

MatchResult Judge::conclude(const SE3& T_a_b, const Matrix6& prior_covariance, double uniqueness,
                            const Budget& budget) const {
  MatchResult result;
  const Look seen = look(T_a_b, prior_covariance);
  result.T_a_b = seen.T_a_b;
  result.evidence = seen.evidence;
  result.evidence.uniqueness = uniqueness;
  result.overlap = result.evidence.overlap;
  result.inlier_ratio = result.evidence.inlier_ratio;
  result.threshold = book_threshold(result.overlap);
  result.book_accepted = result.inlier_ratio > result.threshold;
  const Decision decision = decide(result.evidence);
  result.accepted = decision.accepted;
  result.probability_correct = decision.probability_correct;
  result.reason = decision.reason;
  result.iterations = budget.spent();
  return result;
}

}  // namespace cairn::matching
