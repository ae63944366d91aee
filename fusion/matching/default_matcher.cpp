// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/default_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "fusion/matching/features/landmarks.hpp"
#include "fusion/matching/features/levelling.hpp"
#include "fusion/matching/features/sample.hpp"
#include "fusion/matching/search/constellations.hpp"
#include "fusion/matching/search/global_search.hpp"
#include "fusion/matching/search/stand_up.hpp"

namespace cairn::matching {
namespace {

// Of the look-up of partners: the largest gate of a coarse refinement.
constexpr float kCoarseReach_cells = 3;

/// Whether two refinements that have begun will end at one place. Most modes of a map lead to a few
/// places.
bool one_way(const SE3& T, const SE3& other, const RefinementConfig& config) {
  const SE3 between = T.inverse() * other;
  return between.translation().norm() < config.same_way_m && rotation_angle(between) < config.same_way_rad;
}

template <class Candidate>
bool better(const Candidate& x, const Candidate& y) {
  return x.score > y.score;
}

/// How far ahead the best mode is of the next that is another place.
template <class Candidates>
double uniqueness(const Candidates& best_first) {
  if (best_first.empty()) return 0;
  const auto& best = best_first.front();
  const auto rival = std::find_if(best_first.begin(), best_first.end(),
                                  [&](const auto& c) { return !same_place(c.T_a_b, best.T_a_b); });
  if (rival == best_first.end()) return 1;
  return best.score > 0 ? std::clamp(1 - rival->score / best.score, 0.0, 1.0) : 0;
}

}  // namespace

DefaultMatcher::DefaultMatcher(const MapFeatures& a, const MapFeatures& b, const MatcherConfig& config)
    : config_(config),
      map_a_(a.map()),
      map_b_(b.map()),
      judge_(a, b, config.evidence, config.acceptance),
      modes_(a, b, config.coarse_search),
      coarse_a_(a.coarse()),
      coarse_sample_b_(sample(b.coarse(), config.refinement.coarse_points)),
      climbing_sample_b_(sample(b.coarse(), config.global_search.climb_points)),
      T_level_a_(straightening(a.fine())),
      T_level_b_(straightening(b.fine())),
      coarse_m_(std::max(a.coarse_m(), b.coarse_m())),
      near_coarse_(a.coarse(), coarse_m_, kCoarseReach_cells * coarse_m_) {}

DefaultMatcher::Proposals DefaultMatcher::proposed(Budget& budget) const {
  const GlobalSearchConfig& config = config_.global_search;
  const auto surfels_a = turned(judge_.a().surfels, T_level_a_), surfels_b = turned(judge_.b().surfels, T_level_b_);
  const PlanView a(surfels_a, map_a_, T_level_a_), b(surfels_b, map_b_, T_level_b_);
  const auto voters = sample(std::span<const Surfel>(surfels_b), config.height_votes);
  const auto poses = [&](const std::vector<Placement>& placements) {
    std::vector<SE3> all = stand_up(placements, a, b, voters);
    for (SE3& T : all) T = T_level_a_.inverse() * T * T_level_b_;
    return all;
  };
  const std::size_t most = config.constellations.landmarks;
  return {.of_landmarks = poses(constellations(landmarks(surfels_a, most), landmarks(surfels_b, most), b.middle(),
                                               config.constellations, budget)),
          .swept = poses(sweep(a, b, config, budget))};
}

std::vector<DefaultMatcher::Candidate> DefaultMatcher::climbed(const std::vector<SE3>& poses, Budget& budget) const {
  std::vector<Candidate> best_first;
  for (const SE3& T : poses) best_first.push_back({T, judge_.first_impression(T)});
  std::stable_sort(best_first.begin(), best_first.end(), better<Candidate>);
  best_first.resize(std::min(best_first.size(), config_.global_search.climbers));
  for (Candidate& c : best_first) {
    if (!budget.one_more()) break;
    c.T_a_b = refine(coarse_a_, near_coarse_, climbing_sample_b_, c.T_a_b,
                     config_.refinement.climb.in_metres(coarse_m_), budget)
                  .T_target_source;
    c.score = judge_.first_impression(c.T_a_b);
  }
  std::stable_sort(best_first.begin(), best_first.end(), better<Candidate>);
  return best_first;
}

std::vector<SE3> DefaultMatcher::starts_anywhere(Budget& budget) const {
  const GlobalSearchConfig& config = config_.global_search;
  const auto [of_landmarks, swept] = proposed(budget);
  std::vector<SE3> all = of_landmarks, starts;
  all.insert(all.end(), swept.begin(), swept.end());
  const std::size_t as_they_are = config.best_swept + config.best_constellations;
  for (const Candidate& c : climbed(all, budget)) {
    const auto again = [&](const SE3& T) { return one_way(T, c.T_a_b, config_.refinement); };
    if (starts.size() + as_they_are < config.starts && std::none_of(starts.begin(), starts.end(), again))
      starts.push_back(c.T_a_b);
  }
  const auto add_best = [&](const std::vector<SE3>& poses, std::size_t most) {
    starts.insert(starts.end(), poses.begin(),
                  poses.begin() + static_cast<std::ptrdiff_t>(std::min(poses.size(), most)));
  };
  add_best(of_landmarks, config.best_constellations);
  add_best(swept, config.best_swept);
  return starts;
}

SE3 DefaultMatcher::on_coarse(const SE3& T, const RefinementStage& stage, Budget& budget) const {
  return refine(coarse_a_, near_coarse_, coarse_sample_b_, T, stage.in_metres(coarse_m_), budget).T_target_source;
}

SE3 DefaultMatcher::on_fine(const SE3& T, const RefinementStage& stage, Budget& budget) const {
  return refine(judge_.a().surfels, judge_.near_a(), judge_.b().sample, T, stage.in_metres(judge_.cell_m()), budget)
      .T_target_source;
}

bool DefaultMatcher::leans(const SE3& T) const {
  const double most_rad = config_.refinement.most_lean_sigmas * std::sqrt(anywhere().covariance(3, 3));
  return (T_level_a_ * T * T_level_b_.inverse()).rotation()(2, 2) < std::cos(most_rad);
}

std::vector<DefaultMatcher::Candidate> DefaultMatcher::verified(const std::vector<SE3>& starts, Budget& budget) const {
  const RefinementConfig& config = config_.refinement;
  std::vector<Candidate> candidates;
  std::vector<SE3> under_way;
  for (const SE3& start : starts) {
    if (!budget.one_more()) break;
    const SE3 begun = on_coarse(start, config.begin, budget);
    if (std::any_of(under_way.begin(), under_way.end(), [&](const SE3& T) { return one_way(T, begun, config); }))
      continue;
    under_way.push_back(begun);
    const SE3 T = on_coarse(begun, config.coarse, budget);
    candidates.push_back({T, judge_.score(T)});
  }
  std::stable_sort(candidates.begin(), candidates.end(), better<Candidate>);
  return candidates;
}

void DefaultMatcher::look_closer(std::vector<Candidate>& best_first, Budget& budget) const {
  std::size_t looks = 0;
  for (Candidate& c : best_first) {
    if (looks++ == config_.refinement.closer_looks || !budget.one_more()) break;
    c.T_a_b = on_fine(c.T_a_b, config_.refinement.closer, budget);
    c.score = judge_.score(c.T_a_b);
  }
  std::stable_sort(best_first.begin(), best_first.end(), better<Candidate>);
}

std::vector<DefaultMatcher::Candidate> DefaultMatcher::modes(const std::optional<UncertainPose>& initial,
                                                             Budget& budget) const {
  auto best_first = verified(initial ? modes_.near(*initial) : starts_anywhere(budget), budget);
  if (initial) {
    const auto expected = [&](const Candidate& c) { return within(*initial, c.T_a_b, config_.coarse_search); };
    std::stable_partition(best_first.begin(), best_first.end(), expected);
    return best_first;
  }
  look_closer(best_first, budget);
  std::erase_if(best_first, [&](const Candidate& c) { return leans(c.T_a_b); });
  return best_first;
}

Result<MatchResult> DefaultMatcher::match(const std::optional<UncertainPose>& initial, Budget& budget) const {
  if (auto answer = judge_.without_search(initial)) return *std::move(answer);
  const UncertainPose prior = initial.value_or(anywhere());
  const auto best_first = modes(initial, budget);
  // None when the budget came spent.
  const SE3 best = best_first.empty() ? prior.mean : best_first.front().T_a_b;
  const SE3 refined = on_fine(best, config_.refinement.fine, budget);
  return judge_.conclude(refined, prior.covariance, uniqueness(best_first), budget);
}

std::vector<Look> DefaultMatcher::look_around(const std::optional<UncertainPose>& initial, std::span<const SE3> known,
                                              std::size_t most, Budget& budget) const {
  std::vector<SE3> found(known.begin(), known.end());
  std::vector<Look> looks;
  if (!comparable()) return looks;
  for (const Candidate& c : modes(initial, budget)) {
    const auto is = [](const SE3& T) { return [&T](const SE3& other) { return same_place(other, T); }; };
    if (looks.size() == most || std::any_of(found.begin(), found.end(), is(c.T_a_b))) continue;
    const SE3 T = on_fine(c.T_a_b, config_.refinement.fine, budget);
    if (leans(T) || std::any_of(found.begin(), found.end(), is(T))) continue;
    found.push_back(T);
    looks.push_back(look(T));
  }
  return looks;
}

Look DefaultMatcher::look_again(const SE3& known, Budget& budget) const {
  const SE3 T = on_fine(known, config_.refinement.fine, budget);
  return look(same_place(T, known) && !leans(T) ? T : known);
}

Result<MatchResult> GlobalMatcher::match(const std::optional<UncertainPose>& initial, Budget& budget) const {
  if (auto fault = fault_of(initial)) return *std::move(fault);
  return DefaultMatcher::match(std::nullopt, budget);
}

}  // namespace cairn::matching
