// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/growing_match.hpp"

#include <utility>

#include "fusion/matching/default_matcher.hpp"

namespace cairn::matching {
namespace {

constexpr double kGrowth = 1.2;
constexpr std::size_t kLeastSurfels = 1500, kMostFound = 4;

}  // namespace

bool GrowingMatch::due(const MapFeatures& a, const MapFeatures& b) {
  const auto grown = [](std::size_t now, std::size_t then) {
    return static_cast<double>(now) >= kGrowth * static_cast<double>(then);
  };
  if (!grown(a.fine().size(), searched_a_) && !grown(b.fine().size(), searched_b_)) return false;
  searched_a_ = a.fine().size();
  searched_b_ = b.fine().size();
  return true;
}

void GrowingMatch::update(const MapFeatures& a, const MapFeatures& b, Budget& budget) {
  if (std::min(a.fine().size(), b.fine().size()) < kLeastSurfels) return;
  const DefaultMatcher matcher(a, b);
  if (!matcher.comparable()) return;
  std::vector<Look> looks;
  std::vector<SE3> known;
  for (const SE3& T : hypotheses_.places()) {
    if (!budget.one_more()) break;
    looks.push_back(matcher.look_again(T, budget));
    known.push_back(looks.back().T_a_b.mean);
  }
  if (due(a, b))
    for (Look& look : matcher.look_everywhere(known, kMostFound, budget)) looks.push_back(std::move(look));
  hypotheses_.take(std::move(looks));
}

}  // namespace cairn::matching
