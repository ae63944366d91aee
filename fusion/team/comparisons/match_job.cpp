// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_job.hpp"

#include "fusion/matching/belief/team_consistency.hpp"
#include "fusion/matching/default_matcher.hpp"

namespace cairn::team {
namespace {

void refine(Refinement& refinement, const matching::MapFeatures& own, const matching::MapFeatures& other,
            Budget& budget) {
  const matching::DefaultMatcher matcher(own, other);
  const UncertainPose guess = matching::bent(refinement.guess);
  const auto result = matcher.match(guess, budget);
  if (!result || !result->accepted) return;
  // Its covariance must owe nothing to the guess, which is in the graph already.
  const UncertainPose found = matcher.look(result->T_a_b.mean).T_a_b;
  const Matrix6 spread = guess.covariance + found.covariance;
  if (matching::distance2((guess.mean.inverse() * found.mean).log(), spread) > matching::kChi2) return;
  refinement.found = found;
  refinement.probability = result->probability_correct;
}

}  // namespace

void run(MatchJob& job, Budget& budget) {
  const mapping::SemanticOcTree own_map = job.own.map(), other_map = job.other.map();  // features read them
  const auto own = matching::MapFeatures::build(own_map), other = matching::MapFeatures::build(other_map);
  job.ran = true;
  if (!own || !other) return;
  if (job.refinement)
    refine(*job.refinement, *own, *other, budget);
  else
    job.match->update(*own, *other, budget, job.guess, job.firm > 0);
}

}  // namespace cairn::team
