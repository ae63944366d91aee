// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/evidence/judge.hpp"

#include <algorithm>
#include <cmath>

#include "fusion/matching/evidence/match_covariance.hpp"
#include "fusion/matching/features/sample.hpp"
#include "fusion/matching/features/structure.hpp"
#include "hal/symmetric_eigen.hpp"

namespace cairn::matching {
namespace {

// Standard deviations of a pose without a guess. All chosen by hand, not tuned.
constexpr double kAnywhere_m = 100;         // along x, y and z: frames begin where robots start
constexpr double kAnywhereTilt_rad = 0.03;  // 1.7°: how well a LiDAR's mapping holds gravity
constexpr double kAnywhereHeading_rad = M_PI;
// From a cell's centre to its corners, in cells, with some room for rounding: √3/2 = 0.87.
constexpr float kToCorner_cells = 0.9F;

}  // namespace

UncertainPose anywhere() {
  UncertainPose pose;
  Vector6 sigma;
  sigma << kAnywhere_m, kAnywhere_m, kAnywhere_m, kAnywhereTilt_rad, kAnywhereTilt_rad, kAnywhereHeading_rad;
  pose.covariance = sigma.cwiseAbs2().asDiagonal();
  return pose;
}

Judge::Judge(const MapFeatures& a, const MapFeatures& b, const EvidenceConfig& evidence,
             const AcceptanceConfig& acceptance)
    : config_(evidence),
      acceptance_(acceptance),
      a_(surface_model_of(a, evidence)),
      b_(surface_model_of(b, evidence)),
      cell_m_(std::max(a.fine_m(), b.fine_m())),
      near_a_(a.fine(), cell_m_, evidence.reach_cells * cell_m_),
      near_b_(b.fine(), cell_m_, (evidence.pair_cells + kToCorner_cells) * cell_m_) {}

SurfaceModel surface_model_of(const MapFeatures& map, const EvidenceConfig& config) {
  SurfaceModel model{.surfels = {},
                     .sample = {},
                     .structure = {},
                     .weighed = {},
                     .few = {},
                     .free = FreeSpace(map.map()),
                     .cell_m = static_cast<double>(map.fine_m())};
  model.surfels = facing_free_space(map.fine(), model.free, map.fine_m());
  const auto structure = structure_of(model.surfels);
  model.structure_m2 = static_cast<double>(structure.size()) * model.cell_m * model.cell_m;
  model.sample = sample(std::span<const Surfel>(model.surfels), config.surfels);
  model.structure = sample(std::span<const Surfel>(structure), config.structure);
  model.weighed = sample(std::span<const Surfel>(structure), config.weighed);
  model.few = sample(std::span<const Surfel>(structure), config.few);
  return model;
}

std::optional<Error> fault_of(const std::optional<UncertainPose>& initial) {
  if (!initial) return std::nullopt;
  if (!initial->mean.matrix().allFinite() || !initial->covariance.allFinite())
    return Error{.code = Errc::kInvalidConfig, .cause = "the initial pose is not finite", .where = "initial pose"};
  if (symmetric_eigen(initial->covariance).values[0] <= 0)
    return Error{.code = Errc::kInvalidConfig,
                 .cause = "the initial covariance is not positive definite",
                 .where = "initial pose"};
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
  if (a_.structure.size() < config_.least_structure) return refused(prior, "map a holds too little structure");
  if (b_.structure.size() < config_.least_structure) return refused(prior, "map b holds too little structure");
  return std::nullopt;
}

Look Judge::look(const SE3& T_a_b, const Matrix6& prior_covariance) const {
  return {{T_a_b, covariance(a_, near_a_, b_, T_a_b, prior_covariance, config_)},
          weigh({a_, near_a_}, {b_, near_b_}, T_a_b, config_)};
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
  const Decision decision = decide(result.evidence, acceptance_);
  result.accepted = decision.accepted;
  result.probability_correct = decision.probability_correct;
  result.reason = decision.reason;
  result.iterations = budget.spent();
  return result;
}

}  // namespace cairn::matching
