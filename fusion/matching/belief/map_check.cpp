// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/map_check.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>

#include "fusion/matching/default_matcher.hpp"

namespace cairn::matching {
namespace {

constexpr double kChi2 = 22.46;                    // 99.9 %, 6 degrees of freedom
constexpr double kBendM = 0.03, kBendRad = 0.004;  // what odometry may bend between two submaps, standard deviations
constexpr double kConflict = 0.06;
constexpr int kInCommon = 120;  // sampled structure that agrees or conflicts; less says nothing

Matrix6 bend() {
  Vector6 sigma;
  sigma << kBendM, kBendM, kBendM, kBendRad, kBendRad, kBendRad;
  return sigma.cwiseAbs2().asDiagonal();
}

std::optional<SubmapPair> compare(const MapFeatures& first, const MapFeatures& second, Budget& budget) {
  const DefaultMatcher matcher(first, second);
  if (!matcher.comparable()) return std::nullopt;
  const Look as_they_lie = matcher.look({});
  const double shared = as_they_lie.evidence.structure_inliers > 0
                            ? as_they_lie.evidence.structure_pairs / as_they_lie.evidence.structure_inliers
                            : 0;
  if (shared < kInCommon) return std::nullopt;
  SubmapPair pair;
  const Look refined = matcher.look_again({}, budget);
  pair.slip = refined.T_a_b;
  const Vector6 slip = pair.slip.mean.log();
  pair.chi2 = slip.dot(Matrix6(pair.slip.covariance + bend()).ldlt().solve(slip));
  pair.conflict = as_they_lie.evidence.conflict + as_they_lie.evidence.reverse_conflict;
  pair.consistent = pair.chi2 < kChi2 && pair.conflict < kConflict;
  pair.reason = pair.chi2 >= kChi2           ? "they agree only after one is moved"
                : pair.conflict >= kConflict ? "surfaces of one stand where the other saw free space"
                                             : "they agree as they lie";
  return pair;
}

}  // namespace

std::vector<SubmapPair> check_submaps(std::span<const MapFeatures* const> submaps, Budget& budget) {
  std::vector<SubmapPair> out;
  for (std::size_t j = 1; j < submaps.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      if (!budget.one_more()) return out;
      auto pair = compare(*submaps[i], *submaps[j], budget);
      if (!pair) continue;
      pair->first = i;
      pair->second = j;
      out.push_back(*std::move(pair));
    }
  return out;
}

}  // namespace cairn::matching
