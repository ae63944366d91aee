// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/tilted_matcher.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "fusion/matching/default_matcher.hpp"
#include "fusion/matching/evidence/judge.hpp"
#include "fusion/matching/features/levelling.hpp"
#include "fusion/merging/merge.hpp"

namespace cairn::matching {
namespace {

/// A map in a frame whose z may be upwards, with its features.
struct Levelled {
  std::unique_ptr<mapping::SemanticOcTree> map;
  std::unique_ptr<MapFeatures> features;
};

Result<Levelled> level_map(const mapping::SemanticOcTree& map, const SE3& T_level_map) {
  // Not owned: the caller's map outlives this.
  const std::shared_ptr<const mapping::SemanticOcTree> view(std::shared_ptr<const mapping::SemanticOcTree>{}, &map);
  merging::Contributions alone;
  merging::offer(alone, 0, {.version = 1, .map = view, .T_fused_map = T_level_map});
  auto turned = merging::merge(alone);
  if (!turned) return turned.error();
  auto features = MapFeatures::build(**turned);
  if (!features) return features.error();
  return Levelled{*std::move(turned), std::make_unique<MapFeatures>(*std::move(features))};
}

/// Each turn, and the same upside down.
std::vector<SE3> both_ways(const std::vector<SE3>& turns) {
  const SE3 upside_down(Eigen::Vector3d(1, -1, -1).asDiagonal(), Eigen::Vector3d::Zero());
  std::vector<SE3> all;
  for (const SE3& turn : turns)
    for (const SE3& other : {turn, upside_down * turn}) all.push_back(other);
  return all;
}

/// The result for a map that cannot be turned, such as one at the end of the tree's range.
MatchResult not_levelled(const Error& why) {
  MatchResult result;
  result.T_a_b = anywhere();
  result.reason = "the map cannot be turned upright: " + to_string(why);
  return result;
}

MatchResult in_own_frames(MatchResult result, const SE3& T_level_a, const SE3& T_level_b) {
  const UncertainPose exact_a{T_level_a.inverse()}, exact_b{T_level_b};
  result.T_a_b = compose(compose(exact_a, result.T_a_b), exact_b);
  return result;
}

}  // namespace

Result<MatchResult> TiltedMatcher::match(const std::optional<UncertainPose>& initial, Budget& budget) const {
  if (auto fault = fault_of(initial)) return *std::move(fault);
  const std::vector<SE3> turns_b = both_ways(levellings(b_.fine()));
  std::vector<Levelled> all_b;  // as far as they were needed
  std::optional<MatchResult> best;
  for (const SE3& turn_a : levellings(a_.fine())) {
    const auto a = level_map(a_.map(), turn_a);
    if (!a) return not_levelled(a.error());
    for (std::size_t i = 0; i < turns_b.size(); ++i) {
      if (i == all_b.size()) {
        auto b = level_map(b_.map(), turns_b[i]);
        if (!b) return not_levelled(b.error());
        all_b.push_back(*std::move(b));
      }
      const int spent = budget.spent();
      auto result = GlobalMatcher(*a->features, *all_b[i].features).match(std::nullopt, budget);
      if (!result) return result;
      const bool sure = result->accepted;
      if (!best || sure || result->evidence.score > best->evidence.score)
        best = in_own_frames(*std::move(result), turn_a, turns_b[i]);
      best->iterations = budget.spent();
      if (sure || budget.spent() == spent) return *best;
    }
  }
  return *best;
}

}  // namespace cairn::matching
