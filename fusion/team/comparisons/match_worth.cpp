// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_worth.hpp"

#include <algorithm>

namespace cairn::team {
namespace {

// Shares of the worth of a comparison that is sure to tell something new. Chosen by hand.
constexpr double kOfMerged = 0.2;   // what is believed already seldom changes
constexpr double kOfUnknown = 0.5;  // maps without a pose may have nothing in common
constexpr double kLeastLikely = 0.01;
constexpr double kPlenty = 60;        // tiles in common: more decide no better
constexpr double kLeastCost_s = 0.5;  // the first comparison has no cost yet

}  // namespace

bool MatchWorth::grown(const MatchOutlook& outlook) const {
  const auto grew = [&](std::size_t now, std::size_t then) {
    return now > then && static_cast<double>(now) >= config_.growth * static_cast<double>(then);
  };
  if (outlook.common_tiles && grew(*outlook.common_tiles, then_.common_tiles.value_or(0))) return true;
  if (outlook.merged && outlook.common_tiles) return false;
  return grew(outlook.own_tiles, then_.own_tiles) || grew(outlook.peer_tiles, then_.peer_tiles);
}

Duration MatchWorth::retry() const {
  Duration wait = config_.first_retry;
  for (int i = 0; i < in_vain_ && wait < config_.longest_retry; ++i) wait *= 2;
  return std::min(wait, config_.longest_retry);
}

double MatchWorth::of(const MatchOutlook& outlook, Time now) const {
  const bool first = began_ == Time::min();
  if (!first) {
    if (outlook.own_version == then_.own_version && outlook.peer_version == then_.peer_version) return 0;
    if (rests(now) || (!grown(outlook) && now < began_ + retry())) return 0;
  }
  const double common = outlook.common_tiles ? static_cast<double>(*outlook.common_tiles) / kPlenty : kOfUnknown;
  const double likely = std::clamp(common, kLeastLikely, 1.0) * (outlook.merged ? kOfMerged : 1);
  const double again = first || grown(outlook) ? 1 : 1.0 / (2 + in_vain_);
  return likely * again / std::max(kLeastCost_s, to_seconds(took_));
}

void MatchWorth::begin(const MatchOutlook& outlook, Time now) {
  if (began_ != Time::min() && grown(outlook)) in_vain_ = 0;
  began_ = now;
  then_ = outlook;
}

void MatchWorth::end(bool fruitful, Time now) {
  took_ = now - began_;
  in_vain_ = fruitful ? 0 : in_vain_ + 1;
}

}  // namespace cairn::team
