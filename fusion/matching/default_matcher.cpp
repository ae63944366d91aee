// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/default_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "fusion/matching/features/sample.hpp"
#include "fusion/matching/search/global_search.hpp"

namespace cairn::matching {
namespace {

constexpr std::size_t kRefinePoints = 2000;
constexpr std::size_t kPlacements = 400, kHeightVotes = 600, kGlobalModes = 64, kBestSwept = 24, kCloser = 6;

constexpr RefineOptions kAtFirst{3.0F, 1.25F, 0.75F, 3, 0, 1e-3, 1e-4};  // gates in cells
constexpr RefineOptions kOnCoarse{1.3F, 1.25F, 0.75F, 9, 0, 1e-3, 1e-4};
constexpr RefineOptions kOnFine{4.0F, 2.0F, 0.7F, 30, 0.4F, 1e-4, 1e-5};
constexpr RefineOptions kCloserLook{4.0F, 2.0F, 0.7F, 6, 0, 1e-3, 1e-4};

RefineOptions in_metres(RefineOptions options, float cell_m) {
  options.gate_m *= cell_m;
  options.last_gate_m *= cell_m;
  options.robust_m *= cell_m;
  return options;
}

/// Without a guess, gravity is known: anywhere() says how well. Refinement can lose it where one map has no floor.
bool leans(const SE3& T) {
  constexpr double kMostDeviations = 4;
  const double most_rad = kMostDeviations * std::sqrt(anywhere().covariance(3, 3));
  return T.rotation()(2, 2) < std::cos(most_rad);
}

/// Whether two refinements that have begun will end at one place: most modes of a map lead to a few.
bool one_way(const SE3& T, const SE3& other) {
  constexpr double kNearM = 0.4, kNearRad = 0.04;
  const SE3 between = T.inverse() * other;
  return between.translation().norm() < kNearM && rotation_angle(between) < kNearRad;
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

DefaultMatcher::DefaultMatcher(const MapFeatures& a, const MapFeatures& b)
    : map_a_(a.map()),
      map_b_(b.map()),
      judge_(a, b),
      modes_(a, b),
      coarse_a_(a.coarse()),
      coarse_sample_b_(sample(b.coarse(), kRefinePoints)),
      coarse_m_(std::max(a.coarse_m(), b.coarse_m())),
      near_coarse_(a.coarse(), coarse_m_, 3 * coarse_m_) {}

std::vector<SE3> DefaultMatcher::starts_anywhere(Budget& budget) const {
  const PlanView a(judge_.a().surfels, map_a_), b(judge_.b().surfels, map_b_);
  const auto placements = sweep(a, b, kPlacements, budget);
  const auto voters = sample(std::span<const Surfel>(judge_.b().surfels), kHeightVotes);
  const auto poses = stand_up(placements, a, b, voters);
  std::vector<Candidate> impressions;
  for (const SE3& T : poses) impressions.push_back({T, judge_.first_impression(T)});
  std::stable_sort(impressions.begin(), impressions.end(), better<Candidate>);
  // An impression is better than the sweep at telling right from wrong, but blind where the sweep is half a metre off.
  std::vector<SE3> starts(poses.begin(),
                          poses.begin() + static_cast<std::ptrdiff_t>(std::min(poses.size(), kBestSwept)));
  for (const Candidate& c : impressions)
    if (starts.size() < kGlobalModes) starts.push_back(c.T_a_b);
  return starts;
}

SE3 DefaultMatcher::on_coarse(const SE3& T, const RefineOptions& in_cells, Budget& budget) const {
  return refine(coarse_a_, near_coarse_, coarse_sample_b_, T, in_metres(in_cells, coarse_m_), budget).T_target_source;
}

std::vector<DefaultMatcher::Candidate> DefaultMatcher::verified(const std::vector<SE3>& starts, Budget& budget) const {
  std::vector<Candidate> candidates;
  std::vector<SE3> under_way;
  for (const SE3& start : starts) {
    if (!budget.one_more()) break;
    const SE3 begun = on_coarse(start, kAtFirst, budget);
    if (std::any_of(under_way.begin(), under_way.end(), [&](const SE3& T) { return one_way(T, begun); })) continue;
    under_way.push_back(begun);
    const SE3 T = on_coarse(begun, kOnCoarse, budget);
    candidates.push_back({T, judge_.score(T)});
  }
  std::stable_sort(candidates.begin(), candidates.end(), better<Candidate>);
  return candidates;
}

void DefaultMatcher::look_closer(std::vector<Candidate>& best_first, Budget& budget) const {
  std::size_t looks = 0;
  for (Candidate& c : best_first) {
    if (looks++ == kCloser || !budget.one_more()) break;
    c.T_a_b = refine(judge_.a().surfels, judge_.near_a(), judge_.b().sample, c.T_a_b,
                     in_metres(kCloserLook, judge_.cell_m()), budget)
                  .T_target_source;
    c.score = judge_.score(c.T_a_b);
  }
  std::stable_sort(best_first.begin(), best_first.end(), better<Candidate>);
}

SE3 DefaultMatcher::refined(const SE3& T, Budget& budget) const {
  return refine(judge_.a().surfels, judge_.near_a(), judge_.b().sample, T, in_metres(kOnFine, judge_.cell_m()), budget)
      .T_target_source;
}

std::vector<DefaultMatcher::Candidate> DefaultMatcher::modes(const std::optional<UncertainPose>& initial,
                                                             Budget& budget) const {
  auto best_first = verified(initial ? modes_.near(*initial) : starts_anywhere(budget), budget);
  if (initial) {
    const auto expected = [&](const Candidate& c) { return within(*initial, c.T_a_b); };
    std::stable_partition(best_first.begin(), best_first.end(), expected);
    return best_first;
  }
  look_closer(best_first, budget);
  std::erase_if(best_first, [](const Candidate& c) { return leans(c.T_a_b); });
  return best_first;
}

Result<MatchResult> DefaultMatcher::match(const std::optional<UncertainPose>& initial, Budget& budget) const {
  if (auto answer = judge_.without_search(initial)) return *std::move(answer);
  const UncertainPose prior = initial.value_or(anywhere());
  const auto best_first = modes(initial, budget);
  const SE3 best = best_first.empty() ? prior.mean : best_first.front().T_a_b;  // none when the budget came spent
  return judge_.conclude(refined(best, budget), prior.covariance, uniqueness(best_first), budget);
}

std::vector<Look> DefaultMatcher::look_around(const std::optional<UncertainPose>& initial, std::span<const SE3> known,
                                              std::size_t most, Budget& budget) const {
  std::vector<SE3> found(known.begin(), known.end());
  std::vector<Look> looks;
  if (!comparable()) return looks;
  for (const Candidate& c : modes(initial, budget)) {
    const auto is = [](const SE3& T) { return [&T](const SE3& other) { return same_place(other, T); }; };
    if (looks.size() == most || std::any_of(found.begin(), found.end(), is(c.T_a_b))) continue;
    const SE3 T = refined(c.T_a_b, budget);
    if (leans(T) || std::any_of(found.begin(), found.end(), is(T))) continue;
    found.push_back(T);
    looks.push_back(look(T));
  }
  return looks;
}

Look DefaultMatcher::look_again(const SE3& known, Budget& budget) const {
  const SE3 T = refined(known, budget);
  return look(same_place(T, known) && !leans(T) ? T : known);
}

Result<MatchResult> GlobalMatcher::match(const std::optional<UncertainPose>& initial, Budget& budget) const {
  if (auto fault = fault_of(initial)) return *std::move(fault);
  return DefaultMatcher::match(std::nullopt, budget);
}

}  // namespace cairn::matching
