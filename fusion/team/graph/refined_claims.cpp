// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/graph/refined_claims.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "fusion/matching/belief/team_consistency.hpp"

namespace cairn::team {
namespace {

constexpr int kNear = 8;  // submaps; further apart, odometry explains anything

/// A claim that may be true.
struct Candidate {
  std::size_t at = 0;  // in the list of all
  const PairClaim* claim = nullptr;
  double surprise = 0;  // squared distance to what is known without it
  std::vector<std::size_t> foes;
};

bool comparable(const PairClaim& x, const PairClaim& y) {
  const auto apart = [](std::uint16_t i, std::uint16_t k) { return std::abs(int{i} - int{k}); };
  return x.a == y.a && x.b == y.b && apart(x.submap_a, y.submap_a) <= kNear && apart(x.submap_b, y.submap_b) <= kNear;
}

/// Whether the loop closes that two claims make with the odometry of both robots.
bool agree(const PairClaim& x, const PairClaim& y, const SubmapChains& chains) {
  const UncertainPose over_x = compose(matching::bent(x.T_a_b), motion(chains, x.b, x.submap_b, y.submap_b));
  const UncertainPose over_y = compose(motion(chains, x.a, x.submap_a, y.submap_a), matching::bent(y.T_a_b));
  const UncertainPose around = compose(inverse(over_x), over_y);
  return matching::distance2(around.mean.log(), around.covariance) < matching::kChi2;
}

std::vector<Candidate> unsurprising(std::span<const PairClaim> claims, const Marginals& without,
                                    const SubmapNodes& nodes) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const PairClaim& c = claims[i];
    const auto a = nodes.find({c.a, c.submap_a}), b = nodes.find({c.b, c.submap_b});
    if (!c.refined || a == nodes.end() || b == nodes.end()) continue;
    const UncertainPose known = without.between(a->second, b->second);
    const Matrix6 spread = known.covariance + matching::bent(c.T_a_b).covariance;
    const double surprise = matching::distance2((known.mean.inverse() * c.T_a_b.mean).log(), spread);
    if (surprise < matching::kChi2) candidates.push_back({i, &c, surprise, {}});
  }
  std::ranges::sort(candidates, [](const Candidate& x, const Candidate& y) { return before(*x.claim, *y.claim); });
  return candidates;
}

}  // namespace

std::vector<bool> agreeing_refinements(std::span<const PairClaim> claims, const SubmapChains& chains,
                                       const Marginals& without, const SubmapNodes& nodes) {
  auto candidates = unsurprising(claims, without, nodes);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      Candidate &x = candidates[i], &y = candidates[k];
      if (!comparable(*x.claim, *y.claim) || agree(*x.claim, *y.claim, chains)) continue;
      x.foes.push_back(k);
      y.foes.push_back(i);
    }
  const auto stranger = [](const Candidate& x, const Candidate& y) {
    return x.foes.size() != y.foes.size() ? x.foes.size() < y.foes.size() : x.surprise < y.surprise;
  };
  std::vector<bool> kept(claims.size(), false);
  for (const Candidate& c : candidates) kept[c.at] = true;
  while (!candidates.empty()) {
    const auto worst = std::ranges::max_element(candidates, stranger);
    if (worst->foes.empty()) break;
    kept[worst->at] = false;
    const auto index = static_cast<std::size_t>(std::distance(candidates.begin(), worst));
    for (const std::size_t foe : worst->foes) std::erase(candidates[foe].foes, index);
    worst->foes.clear();
  }
  return kept;
}

}  // namespace cairn::team
