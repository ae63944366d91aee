// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/default_matcher.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fusion/matching/acceptance.hpp"
#include "fusion/matching/sample.hpp"

namespace cairn::matching {
namespace {

constexpr std::size_t kSearchPoints = 2000, kRefinePoints = 2000, kFinePoints = 8000, kVerifyPoints = 1500;
constexpr std::size_t kMinStructure = 20;
constexpr int kModes = 16, kWideModes = 48;
constexpr double kWindowSigmas = 3, kMinWindowM = 0.8, kMaxWindowM = 20, kMaxHeightM = 4, kMinYaw = 0.07;
constexpr double kOneHeightM = 0.5;  // a prior that knows the height better than this needs no search over it
constexpr double kWideYaw = 1.0;
constexpr double kSameM = 0.8, kSameRad = 0.07;  // refined modes this close are one

constexpr RefineOptions kOnCoarse{3.0F, 1.25F, 0.75F, 12, 1e-3, 1e-4};  // gates in cells
constexpr RefineOptions kOnFine{4.0F, 2.0F, 0.7F, 30, 1e-4, 1e-5};

RefineOptions in_metres(RefineOptions options, float cell_m) {
  options.gate_m *= cell_m;
  options.last_gate_m *= cell_m;
  return options;
}

std::vector<Surfel> structure_of(std::span<const Surfel> surfels) {
  std::vector<Surfel> out;
  std::copy_if(surfels.begin(), surfels.end(), std::back_inserter(out), [](const Surfel& s) { return s.structure(); });
  return out;
}

std::vector<Eigen::Vector3f> points_of(std::span<const Surfel> surfels) {
  std::vector<Eigen::Vector3f> points(surfels.size());
  std::transform(surfels.begin(), surfels.end(), points.begin(), [](const Surfel& s) { return s.point; });
  return points;
}

Party party_of(const MapFeatures& map) {
  return {map.fine(), sample(map.fine(), kFinePoints),
          sample(std::span<const Surfel>(structure_of(map.fine())), kVerifyPoints), FreeSpace(map.map()),
          static_cast<double>(map.fine_m())};
}

/// Three standard deviations of the prior, within what a search can cover. Positions are of the source's origin.
SearchWindow window_of(const UncertainPose& prior) {
  const Eigen::Matrix3d R = prior.mean.rotation();
  const Eigen::Matrix3d position = R * prior.covariance.topLeftCorner<3, 3>() * R.transpose();
  const double xy = std::sqrt(
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(position.topLeftCorner<2, 2>()).eigenvalues().maxCoeff());
  const double z = std::sqrt(std::max(0.0, position(2, 2)));
  SearchWindow window;
  window.xy_m = std::clamp(kWindowSigmas * xy, kMinWindowM, kMaxWindowM);
  window.z_m = z > kOneHeightM ? std::min(kWindowSigmas * z, kMaxHeightM) : 0;
  window.yaw_rad = std::clamp(kWindowSigmas * std::sqrt(prior.covariance(5, 5)), kMinYaw, M_PI);
  return window;
}

/// What a match without a guess starts from.
UncertainPose anywhere() {
  UncertainPose pose;
  Vector6 sigma;
  sigma << 10 / kWindowSigmas, 10 / kWindowSigmas, 0.3, 0.03, 0.03, M_PI;
  pose.covariance = sigma.cwiseAbs2().asDiagonal();
  return pose;
}

bool same_place(const SE3& a, const SE3& b) {
  const SE3 between = a.inverse() * b;
  return between.translation().norm() < kSameM && rotation_angle(between) < kSameRad;
}

}  // namespace

std::optional<Error> fault_of(const std::optional<UncertainPose>& initial) {
  if (!initial) return std::nullopt;
  if (!initial->mean.matrix().allFinite() || !initial->covariance.allFinite())
    return Error{Errc::kInvalidConfig, "the initial pose is not finite", "initial pose"};
  if (Eigen::SelfAdjointEigenSolver<Matrix6>(initial->covariance).eigenvalues()[0] <= 0)
    return Error{Errc::kInvalidConfig, "the initial covariance is not positive definite", "initial pose"};
  return std::nullopt;
}

Matrix6 default_prior_covariance() {
  Vector6 sigma;
  sigma << 0.8, 0.8, 0.3, 0.03, 0.03, 0.105;
  return sigma.cwiseAbs2().asDiagonal();
}

DefaultMatcher::DefaultMatcher(const MapFeatures& a, const MapFeatures& b)
    : a_(party_of(a)),
      b_(party_of(b)),
      structure_a_(points_of(structure_of(a.coarse()))),
      structure_b_(sample(std::span<const Eigen::Vector3f>(points_of(structure_of(b.coarse()))), kSearchPoints)),
      coarse_a_(a.coarse()),
      coarse_sample_b_(sample(b.coarse(), kRefinePoints)),
      coarse_m_(std::max(a.coarse_m(), b.coarse_m())),
      near_coarse_(a.coarse(), coarse_m_, 3 * coarse_m_),
      near_fine_(a.fine(), std::max(a.fine_m(), b.fine_m()), 4 * std::max(a.fine_m(), b.fine_m())) {}

std::vector<DefaultMatcher::Candidate> DefaultMatcher::verified_modes(const SE3& initial, const SearchWindow& window,
                                                                      int modes, Budget& budget) const {
  const LikelihoodField field(structure_a_, std::max(0.4F, coarse_m_), window);
  std::vector<Candidate> candidates;
  for (const Mode& mode : search(field, structure_b_, initial, window, modes)) {
    if (!budget.one_more()) break;
    const Refinement r = refine(coarse_a_, near_coarse_, coarse_sample_b_, mode.T_target_source,
                                in_metres(kOnCoarse, coarse_m_), budget);
    candidates.push_back({r.T_target_source, score(a_, near_fine_, b_, r.T_target_source)});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.score > y.score; });
  return candidates;
}

Result<MatchResult> DefaultMatcher::match(const std::optional<UncertainPose>& initial, Budget& budget) const {
  if (auto fault = fault_of(initial)) return *std::move(fault);
  const UncertainPose prior = initial.value_or(anywhere());
  MatchResult result;
  result.T_a_b = prior;
  if (structure_a_.size() < kMinStructure || structure_b_.size() < kMinStructure) {
    result.reason =
        std::string(structure_a_.size() < kMinStructure ? "map a" : "map b") + " holds too little structure";
    return result;
  }
  const SearchWindow window = window_of(prior);
  const auto modes = verified_modes(prior.mean, window, window.yaw_rad > kWideYaw ? kWideModes : kModes, budget);
  const auto cell = static_cast<float>(std::max(a_.cell_m, b_.cell_m));
  const SE3 T =
      refine(a_.surfels, near_fine_, b_.sample, modes.front().T_a_b, in_metres(kOnFine, cell), budget).T_target_source;
  result.T_a_b = {T, covariance(a_, near_fine_, b_, T, prior.covariance)};
  result.evidence = weigh(a_, near_fine_, b_, T);
  const auto rival = std::find_if(modes.begin(), modes.end(),
                                  [&](const Candidate& c) { return !same_place(c.T_a_b, modes.front().T_a_b); });
  if (rival != modes.end() && modes.front().score > 0)
    result.evidence.uniqueness = std::clamp(1 - rival->score / modes.front().score, 0.0, 1.0);
  else if (rival != modes.end())
    result.evidence.uniqueness = 0;
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
