// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/match_worth.hpp"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

constexpr double kOfMerged = 0.2;   // what is believed already seldom changes
constexpr double kOfUnknown = 0.5;  // maps without a pose may have nothing in common
constexpr double kPlenty = 60;      // tiles in common: more decide no better
constexpr double kLeastCostS = 0.5;
constexpr std::size_t kLookedAt = 128;  // of b, often
constexpr int kEdge = 1 << TileKey::kVoxelBits, kMiddle = 32768;

/// The tile at a place of the map, given in voxels from its origin; beyond the map: the last one there is.
TileKey tile_at(const Eigen::Vector3d& voxels) {
  const auto key = [&](int axis) {
    return static_cast<std::uint16_t>(std::clamp(std::floor(voxels[axis]) + kMiddle, 0.0, 65535.0));
  };
  return TileKey::of_voxel(key(0), key(1), key(2));
}

/// Turned against the other map's, a tile's walls may be in the next one.
bool meets(const std::set<TileKey>& tiles, const Eigen::Vector3d& voxels) {
  if (tiles.contains(tile_at(voxels))) return true;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-kEdge / 2.0, kEdge / 2.0})
      if (tiles.contains(tile_at(voxels + side * Eigen::Vector3d::Unit(axis)))) return true;
  return false;
}

}  // namespace

std::size_t tiles_of_both(const std::set<TileKey>& a, const std::set<TileKey>& b, const SE3& T_a_b,
                          double resolution_m) {
  const std::size_t step = std::max<std::size_t>(1, (b.size() + kLookedAt - 1) / kLookedAt);
  std::size_t common = 0, i = 0;
  for (const TileKey tile : b) {
    if (i++ % step != 0) continue;
    Eigen::Vector3d middle;
    for (unsigned axis = 0; axis < 3; ++axis) middle[axis] = tile.first_voxel(axis) - kMiddle + kEdge / 2.0;
    common += meets(a, T_a_b * (resolution_m * middle) / resolution_m) ? step : 0;
  }
  return std::min(common, b.size());
}

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
  const double likely = std::clamp(common, 0.01, 1.0) * (outlook.merged ? kOfMerged : 1);
  const double again = first || grown(outlook) ? 1 : 1.0 / (2 + in_vain_);
  return likely * again / std::max(kLeastCostS, to_seconds(took_));
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

}  // namespace cairn
