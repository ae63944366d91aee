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

// A map is compared again after a way of this share of the way before, and of so many metres. The map's size would not
// tell: a small room is known to its walls after one scan, and its map shrinks from then on, because what is sure takes
// fewer nodes. A comparison takes half a second of a core: at 1 m/s, the most is a tenth of its time.
constexpr double kLonger = 0.15, kLeastWay_m = 1, kMostWay_m = 5;
// A turn by a radian shows as much as a way of so many metres, to a camera.
constexpr double kTurn_m = 1;
// Each about a millisecond of a NUC.
constexpr std::size_t kNodesInAStep = 20'000, kTilesInAStep = 64;
constexpr double kNever = std::numeric_limits<double>::max();

double next_after(double way_m) { return way_m + std::clamp(kLonger * way_m, kLeastWay_m, kMostWay_m); }

}  // namespace

std::optional<RejoinJob> RejoinPlan::step(Time now) {
  begin(robot_.map_epoch());
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
  compared_at_m_[map->epoch] = way_m_;
  out_ = true;
  return RejoinJob{.earlier_epoch = map->epoch,
                   .present_epoch = epoch_,
                   .earlier = map->tree,
                   .present = std::move(present),
                   .guess = map->epoch + 1 == epoch_ ? map->T_next_earlier : std::nullopt};
}

/// The one that has waited longest. None: the robot has not gone on since, or all are joined.
const EarlierMap* RejoinPlan::next_map() const {
  const EarlierMap* next = nullptr;
  double least = std::numeric_limits<double>::max();
  for (const EarlierMap& map : robot_.earlier_maps().all()) {
    const auto then = compared_at_m_.find(map.epoch);
    const double due_m = then != compared_at_m_.end() ? next_after(then->second) : 0;
    if (map.joined || due_m >= least) continue;
    least = due_m;
    next = &map;
  }
  return way_m_ >= least ? next : nullptr;
}

void RejoinPlan::went_to(const SE3& T_odom_base, std::uint32_t epoch) {
  if (begin(epoch)) last_ = T_odom_base;
  const SE3 motion = last_.inverse() * T_odom_base;
  way_m_ += motion.translation().norm() + kTurn_m * rotation_angle(motion);
  last_ = T_odom_base;
}

bool RejoinPlan::begin(std::uint32_t epoch) {
  if (std::exchange(epoch_, epoch) == epoch) return false;
  copy_.reset();
  joining_.reset();
  compared_at_m_.clear();
  way_m_ = 0;
  return true;
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
    compared_at_m_[joining_->earlier_epoch] = kNever;
    monitor_.event(now, "rejoin", name + " was found again, but not all of it has room: " + to_string(filled.error()));
  }
  joining_.reset();
}

void RejoinPlan::finish(Time now) {
  if (joining_ && joining_->present_epoch == robot_.map_epoch()) join(std::numeric_limits<std::size_t>::max(), now);
}

}  // namespace cairn::app
