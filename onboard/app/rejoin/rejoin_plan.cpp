// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/rejoin/rejoin_plan.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "onboard/app/rejoin/joined_track.hpp"

namespace cairn::app {
namespace {

// A map is compared again when it has so many times the nodes.
constexpr double kGrowth = 1.15;
// Each about a millisecond of a NUC.
constexpr std::size_t kNodesInAStep = 20'000, kTilesInAStep = 64;
// No map grows beyond this size.
constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max() / 2;

}  // namespace

std::optional<RejoinJob> RejoinPlan::step(Time now) {
  if (std::exchange(epoch_, robot_.map_epoch()) != robot_.map_epoch()) {
    copy_.reset();
    joining_.reset();
    compared_with_.clear();
  }
  if (joining_) {
    join(kTilesInAStep, now);
    return std::nullopt;
  }
  if (!copy_ && (out_ || now < due_ || next_map() == nullptr)) return std::nullopt;
  if (!copy_) copy_.emplace(robot_.map());
  if (!copy_->step(robot_.map(), kNodesInAStep)) return std::nullopt;
  auto present = std::exchange(copy_, std::nullopt)->take();
  const EarlierMap* map = next_map();
  if (map == nullptr) return std::nullopt;
  compared_with_[map->epoch] = robot_.map().size();
  out_ = true;
  return RejoinJob{
      .earlier_epoch = map->epoch, .present_epoch = epoch_, .earlier = map->tree, .present = std::move(present)};
}

/// The one with which the smallest present map was compared. None: the present map has not grown since, or all are
/// joined.
const EarlierMap* RejoinPlan::next_map() const {
  const EarlierMap* next = nullptr;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const EarlierMap& map : robot_.earlier_maps().all()) {
    const auto then = compared_with_.find(map.epoch);
    const std::size_t size = then != compared_with_.end() ? then->second : 0;
    if (map.joined || size >= least) continue;
    least = size;
    next = &map;
  }
  const auto now = static_cast<double>(robot_.map().size());
  return now > kGrowth * static_cast<double>(least) ? next : nullptr;
}

void RejoinPlan::take(RejoinJob result, Time now) {
  out_ = false;
  due_ = now + kPeriod;
  if (result.present_epoch != robot_.map_epoch() || !result.T_present_earlier) return;
  joining_ = std::move(result);
  joined_tiles_ = 0;
}

void RejoinPlan::join(std::size_t tiles, Time now) {
  const auto& all = joining_->tiles;
  const auto part = std::span(all).subspan(joined_tiles_, std::min(tiles, all.size() - joined_tiles_));
  const auto filled = robot_.fill_map(part, *joining_->moved);
  joined_tiles_ += part.size();
  if (filled && joined_tiles_ < all.size()) return;
  const std::string name = earlier_map_file(joining_->earlier_epoch);
  if (filled) {
    robot_.note_joined(joining_->earlier_epoch, *joining_->T_present_earlier);
    monitor_.event(now, "rejoin", "an earlier map was found again: the map has all that " + name + " knows");
  } else {
    compared_with_[joining_->earlier_epoch] = kNever;
    monitor_.event(now, "rejoin", name + " was found again, but not all of it has room: " + to_string(filled.error()));
  }
  joining_.reset();
}

void RejoinPlan::finish(Time now) {
  if (joining_ && joining_->present_epoch == robot_.map_epoch()) join(std::numeric_limits<std::size_t>::max(), now);
}

}  // namespace cairn::app
