// SPDX-License-Identifier: Apache-2.0
#include "tools/team/figures/map_overlap.hpp"

namespace cairn::team_run {
namespace {

/// In the voxel of a point, or in one of its 26 neighbours.
bool occupied_near(const mapping::SemanticOcTree& tree, const Eigen::Vector3d& p) {
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d q = p + tree.getResolution() * Eigen::Vector3d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    const mapping::SemanticNode* node = tree.search(q.x(), q.y(), q.z());
    if (node != nullptr && tree.isNodeOccupied(node)) return true;
  }
  return false;
}

bool knows(const mapping::SemanticOcTree& map, const Eigen::Vector3d& p) {
  return map.search(p.x(), p.y(), p.z()) != nullptr;
}

template <class Visit>
void for_each_occupied(const mapping::SemanticOcTree& map, Visit&& visit) {
  for (auto leaf = map.begin_leafs(), end = map.end_leafs(); leaf != end; ++leaf)
    if (map.isNodeOccupied(*leaf)) visit(Eigen::Vector3d(leaf.getX(), leaf.getY(), leaf.getZ()));
}

}  // namespace

std::optional<double> iou_with_world(const mapping::SemanticOcTree& map, const SE3& T_world_map,
                                     const mapping::SemanticOcTree& world, const Area* within) {
  const SE3 T_area_map = within != nullptr ? within->T_map_area.inverse() : SE3();
  const auto counts = [&](const Eigen::Vector3d& p) { return within == nullptr || knows(within->map, T_area_map * p); };
  std::size_t both = 0, only_map = 0, missed = 0;
  for_each_occupied(map, [&](const Eigen::Vector3d& p) {
    if (counts(p)) ++(occupied_near(world, T_world_map * p) ? both : only_map);
  });
  const SE3 T_map_world = T_world_map.inverse();
  for_each_occupied(world, [&](const Eigen::Vector3d& q) {
    const Eigen::Vector3d p = T_map_world * q;
    if (knows(map, p) && counts(p) && !occupied_near(map, p)) ++missed;
  });
  const std::size_t either = both + only_map + missed;
  if (either == 0) return std::nullopt;
  return static_cast<double>(both) / static_cast<double>(either);
}

std::size_t occupied_leaves(const mapping::SemanticOcTree& map) {
  std::size_t count = 0;
  for_each_occupied(map, [&](const Eigen::Vector3d&) { ++count; });
  return count;
}

SE3 sight_error(const Standing& a, const Standing& b, const SE3& T_a_b) {
  const SE3 truth = a.T_world_base.inverse() * b.T_world_base;
  const SE3 estimate = a.T_odom_base.inverse() * T_a_b * b.T_odom_base;
  return truth.inverse() * estimate;
}

bool is_wrong_merge(const SE3& sight_error) {
  constexpr double kMost_m = 1, kMost_rad = 0.17;  // ten degrees
  return sight_error.translation().norm() > kMost_m || rotation_angle(sight_error) > kMost_rad;
}

}  // namespace cairn::team_run
