// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_job.hpp"

#include <limits>
#include <span>

#include "fusion/matching/belief/team_consistency.hpp"
#include "fusion/matching/default_matcher.hpp"
#include "fusion/merging/team_map.hpp"
#include "fusion/peers/items/tile_codec.hpp"

namespace cairn {
namespace {

void refine(Refinement& refinement, const matching::MapFeatures& own, const matching::MapFeatures& other,
            Budget& budget) {
  const matching::DefaultMatcher matcher(own, other);
  const UncertainPose guess = matching::bent(refinement.guess);
  const auto result = matcher.match(guess, budget);
  if (!result || !result->accepted) return;
  // With a covariance that owes nothing to the guess, which is in the graph already.
  const UncertainPose found = matcher.look(result->T_a_b.mean).T_a_b;
  const Matrix6 spread = guess.covariance + found.covariance;
  if (matching::distance2((guess.mean.inverse() * found.mean).log(), spread) > matching::kChi2) return;
  refinement.found = found;
  refinement.probability = result->probability_correct;
}

}  // namespace

SE3 SaidTiles::T_map_odom_of(std::uint16_t submap) const {
  const auto found = T_map_odom.find(submap);
  return found == T_map_odom.end() ? SE3() : found->second;
}

SemanticOcTree SaidTiles::map() const {
  const auto state_of = [&](const Tile& tile) {
    return peers::decode_tile(std::span(payloads).subspan(tile.begin, tile.bytes));
  };
  if (T_map_odom.empty()) {
    SemanticOcTree map(resolution_m);
    for (const Tile& tile : tiles)
      if (const auto state = state_of(tile)) write_tile(map, tile.key, *state);
    return map;
  }
  merging::TeamMap moved(resolution_m, merging::Policy::kRelativeEntropy);
  merging::SubmapPoses poses;
  for (const Tile& tile : tiles) {
    if (const auto state = state_of(tile)) moved.put({0, tile.submap}, tile.key, *state, Time{});
    poses.emplace(merging::SubmapKey{0, tile.submap}, T_map_odom_of(tile.submap));
  }
  moved.place(poses);
  Budget all = Budget::steps(std::numeric_limits<int>::max());
  (void)moved.fuse(all);
  return moved.map();
}

void run(MatchJob& job, Budget& budget) {
  const SemanticOcTree own_map = job.own.map(), other_map = job.other.map();  // features read them
  const auto own = matching::MapFeatures::build(own_map), other = matching::MapFeatures::build(other_map);
  job.ran = true;
  if (!own || !other) return;
  if (job.refinement)
    refine(*job.refinement, *own, *other, budget);
  else
    job.match->update(*own, *other, budget, job.guess);
}

}  // namespace cairn
