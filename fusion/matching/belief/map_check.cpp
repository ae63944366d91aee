// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/map_check.hpp"

#include <optional>

#include "fusion/matching/belief/team_consistency.hpp"
#include "fusion/matching/default_matcher.hpp"

namespace cairn::matching {
namespace {

Matrix6 covariance_of_odometry(const MapCheckConfig& config) {
  Vector6 sigma;
  sigma << config.bend_m, config.bend_m, config.bend_m, config.bend_rad, config.bend_rad, config.bend_rad;
  return sigma.cwiseAbs2().asDiagonal();
}

std::optional<SubmapPair> compare(const MapFeatures& first, const MapFeatures& second, Budget& budget,
                                  const MapCheckConfig& config) {
  MatcherConfig matching;
  matching.evidence.weighed = config.samples;
  const DefaultMatcher matcher(first, second, matching);
  if (!matcher.comparable()) return std::nullopt;
  const Look as_they_lie = matcher.look({});
  const double shared = as_they_lie.evidence.structure_inliers > 0
                            ? as_they_lie.evidence.structure_pairs / as_they_lie.evidence.structure_inliers
                            : 0;
  if (shared < config.least_in_common) return std::nullopt;
  SubmapPair pair;
  const Look refined = matcher.look_again({}, budget);
  pair.slip = refined.T_a_b;
  pair.chi2 = distance2(pair.slip.mean.log(), pair.slip.covariance + covariance_of_odometry(config));
  pair.conflict = as_they_lie.evidence.conflict + as_they_lie.evidence.reverse_conflict;
  pair.consistent = pair.chi2 < kChi2 && pair.conflict < config.most_conflict;
  pair.reason = pair.chi2 >= kChi2                      ? "they agree only after one is moved"
                : pair.conflict >= config.most_conflict ? "surfaces of one stand where the other saw free space"
                                                        : "they agree as they lie";
  return pair;
}

}  // namespace

std::vector<SubmapPair> check_submaps(std::span<const MapFeatures* const> submaps, Budget& budget,
                                      const MapCheckConfig& config) {
  std::vector<SubmapPair> out;
  for (std::size_t j = 1; j < submaps.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      if (!budget.one_more()) return out;
      auto pair = compare(*submaps[i], *submaps[j], budget, config);
      if (!pair) continue;
      pair->first = i;
      pair->second = j;
      out.push_back(*std::move(pair));
    }
  return out;
}

}  // namespace cairn::matching
