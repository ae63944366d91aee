// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/belief/growing_match.hpp"

#include <algorithm>
#include <utility>

#include "fusion/matching/belief/guess.hpp"
#include "fusion/matching/default_matcher.hpp"

namespace cairn::matching {

bool GrowingMatch::due(const MapFeatures& a, const MapFeatures& b) const {
  const auto grown = [&](std::size_t now, std::size_t then) {
    return static_cast<double>(now) >= config_.growth * static_cast<double>(then);
  };
  return grown(a.fine().size(), searched_a_) || grown(b.fine().size(), searched_b_);
}

bool GrowingMatch::would_accept(const std::vector<Look>& looks, const std::optional<UncertainPose>& guess) const {
  if (hypotheses_.accepted() != nullptr) return false;
  PendingHypotheses then = hypotheses_;
  then.take(looks, guess);
  return then.accepted() != nullptr;
}

void GrowingMatch::update(const MapFeatures& a, const MapFeatures& b, Budget& budget,
                          const std::optional<UncertainPose>& given, bool firm) {
  const auto guess = given && worth_following(*given) ? given : std::nullopt;
  if (std::min(a.fine().size(), b.fine().size()) < config_.least_surfels) return;
  const DefaultMatcher matcher(a, b, config_.matcher);
  if (!matcher.comparable()) return;
  std::vector<Look> looks;
  std::vector<SE3> known;
  for (const SE3& T : hypotheses_.places()) {
    if (!budget.one_more()) break;
    looks.push_back(matcher.look_again(T, budget));
    known.push_back(looks.back().T_a_b.mean);
  }
  const auto held = [&](const SE3& T) {
    return std::ranges::any_of(hypotheses_.all(), [&](const Hypothesis& h) { return same_place(h.T_a_b.mean, T); });
  };
  if (guess && !held(guess->mean)) {  // so that the maps can say no
    looks.push_back(matcher.look_again(guess->mean, budget));
    known.push_back(looks.back().T_a_b.mean);
  }
  const auto search = [&](const std::optional<UncertainPose>& initial, std::size_t most) {
    for (Look& look : matcher.look_around(initial, known, most, budget)) {
      known.push_back(look.T_a_b.mean);
      looks.push_back(std::move(look));
    }
  };
  if (due(a, b) || would_accept(looks, guess)) {
    if (guess) search(guess, config_.most_near);
    search({}, config_.most_found);
    searched_a_ = a.fine().size();
    searched_b_ = b.fine().size();
  }
  denied_.reset();
  if (given && firm) deny(looks, *given);
  hypotheses_.take(std::move(looks), guess);
}

/// A look that is not taken leaves its place as it was, so both must not mix: firm word begins with a new match.
void GrowingMatch::deny(std::vector<Look>& looks, const UncertainPose& firm) {
  const auto elsewhere = [&](const Look& look) { return !agrees(firm, look.T_a_b.mean); };
  for (const Look& look : looks) {
    const Decision decision = decide(look.evidence, config_.matcher.acceptance);
    if (!denied_ && elsewhere(look) && decision.probability_correct >= config_.belief.agrees) denied_ = look.T_a_b.mean;
  }
  std::erase_if(looks, elsewhere);
}

}  // namespace cairn::matching
