// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/submap_check.hpp"

#include <algorithm>
#include <bit>

namespace cairn::peers {
namespace {

constexpr double kPast = 0.7;  // what the batches before count: the last three or so
// Batches: the first ones are of a map that is hardly there; so many are remembered, which is a minute.
constexpr int kFirst = 10, kUsual = 120;

/// Occupied, with something occupied right above or below within the tile.
std::uint64_t walls_of(const mapping::TileState& tile, unsigned z) {
  const std::uint64_t below = z > 0 ? tile.occupied[z - 1] : 0;
  const std::uint64_t above = z + 1 < mapping::TileState::kEdge ? tile.occupied[z + 1] : 0;
  return tile.occupied[z] & (below | above);
}

/// Whose grade has become higher: less sure.
std::uint64_t less_sure(const mapping::TileState& before, const mapping::TileState& now, unsigned z) {
  const std::uint64_t same_high = ~(now.high[z] ^ before.high[z]);
  return (now.high[z] & ~before.high[z]) | (same_high & now.low[z] & ~before.low[z]);
}

}  // namespace

SeenAgain seen_again(const mapping::TileState& before, const mapping::TileState& now) {
  SeenAgain seen;
  for (unsigned z = 0; z < mapping::TileState::kEdge; ++z) {
    const std::uint64_t again = walls_of(before, z) & now.known[z];
    const std::uint64_t stood = again & now.occupied[z] & ~less_sure(before, now, z);
    const std::uint64_t filled = walls_of(now, z) & before.known[z] & ~before.occupied[z];
    seen.stood += std::popcount(stood);
    seen.contradicted += std::popcount(again & ~stood) + std::popcount(filled);
  }
  return seen;
}

double SubmapCheck::share() const {
  const double all = stood_ + contradicted_;
  return all < kLeastVoxels ? 0 : contradicted_ / all;
}

bool SubmapCheck::contradicted() const {
  if (batches_ < kFirst) return false;
  const bool before = doubt_ == Doubt::kContradicted;
  return share() > (before ? std::max(kFew, kFewTimes * usual_) : std::max(kMost, kTimes * usual_));
}

/// Also in doubt, so that none lasts for ever: what is always so is usual.
void SubmapCheck::learn_usual() {
  if (share() == 0) return;
  batches_ = std::min(batches_ + 1, kUsual);
  usual_ += (share() - usual_) / batches_;
}

void SubmapCheck::judge(bool lost, const SeenAgain& seen) {
  stood_ = kPast * stood_ + seen.stood;
  contradicted_ = kPast * contradicted_ + seen.contradicted;
  const bool contradicted = this->contradicted();
  learn_usual();
  if (contradicted) doubt_ = Doubt::kContradicted;
  if (lost && doubt_ == Doubt::kNone) doubt_ = Doubt::kLost;
  if (lost || contradicted)
    sure_ = 0;
  else if (doubt_ != Doubt::kNone && ++sure_ >= kSureBatches)
    doubt_ = Doubt::kNone;
}

}  // namespace cairn::peers
