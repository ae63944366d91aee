// SPDX-License-Identifier: Apache-2.0
#include "fusion/team/comparisons/published_edge.hpp"

namespace cairn::team {
namespace {

// An edge that moves by less is not worth a datagram: a tenth of a voxel, and as much at 7 m.
constexpr double kMoved_m = 0.02, kTurned_rad = 0.003;

bool moved(const SE3& from, const SE3& to) {
  const SE3 change = from.inverse() * to;
  return change.translation().norm() > kMoved_m || rotation_angle(change) > kTurned_rad;
}

bool same(const peers::Edge& published, const peers::Edge& now) {
  return published.own_submap == now.own_submap && published.other_submap == now.other_submap &&
         !moved(published.T_own_other.mean, now.T_own_other.mean);
}

}  // namespace

std::optional<IndexedEdge> PublishedEdge::update(const std::optional<peers::Edge>& edge) {
  if (!edge && !stands()) return std::nullopt;
  if (edge && stands() && same(*last_, *edge)) return std::nullopt;
  if (edge)
    last_ = edge;
  else
    last_->probability = 0;
  return IndexedEdge{index_, *last_};
}

}  // namespace cairn::team
