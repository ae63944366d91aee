// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/view/planner_view.hpp"

#include <cmath>

#include "onboard/mapping/tree/key_at.hpp"

namespace cairn::client {
namespace {

Occupancy occupancy_in(const mapping::SemanticOcTree& map, const octomap::OcTreeKey& key) {
  const mapping::SemanticNode* node = map.search(key);
  if (node == nullptr) return Occupancy::kUnknown;
  return map.isNodeOccupied(node) ? Occupancy::kOccupied : Occupancy::kFree;
}

Occupancy occupancy_in(const mapping::SemanticOcTree& map, const Eigen::Vector3d& p) {
  const auto key = mapping::key_at(map, p);
  return key ? occupancy_in(map, *key) : Occupancy::kUnknown;
}

Place place_in(const MapMirror& mirror, const Eigen::Vector3d& p, bool own) {
  const auto key = mapping::key_at(mirror.map(), p);
  if (!key) return {};
  Place place{.occupancy = occupancy_in(mirror.map(), *key), .own = own, .robots = {}, .changed = {}};
  if (place.occupancy == Occupancy::kUnknown) return {};
  if (const auto* origin = mirror.origin_of(mapping::TileKey::of_voxel(key->k[0], key->k[1], key->k[2]))) {
    place.robots = origin->robots;
    place.changed = origin->changed;
  }
  return place;
}

}  // namespace

PlannerView::PlannerView(const MapMirror& own, const MapMirror* team, const std::optional<SE3>& T_team_odom)
    : own_(own), team_(T_team_odom ? team : nullptr), T_team_odom_(T_team_odom.value_or(SE3())) {}

Place PlannerView::at(const Eigen::Vector3d& p_odom) const {
  const Place seen = place_in(own_, p_odom, true);
  if (seen.occupancy != Occupancy::kUnknown || team_ == nullptr) return seen;
  return place_in(*team_, T_team_odom_ * p_odom, false);
}

Occupancy PlannerView::occupancy(const Eigen::Vector3d& p_odom) const {
  const Occupancy seen = occupancy_in(own_.map(), p_odom);
  if (seen != Occupancy::kUnknown || team_ == nullptr) return seen;
  return occupancy_in(team_->map(), T_team_odom_ * p_odom);
}

std::optional<Eigen::Vector3d> PlannerView::first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  // No map is larger than a tree, so no ray needs more steps.
  constexpr double kMostSteps = 1 << 18;
  const double steps = std::ceil((to - from).norm() / (0.5 * resolution_m()));
  if (!(steps <= kMostSteps)) return std::nullopt;
  for (int i = 0; i <= static_cast<int>(steps); ++i) {
    const Eigen::Vector3d p = steps > 0 ? Eigen::Vector3d(from + (to - from) * (i / steps)) : from;
    if (occupancy(p) == Occupancy::kOccupied) return p;
  }
  return std::nullopt;
}

}  // namespace cairn::client
