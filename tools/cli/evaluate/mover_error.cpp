// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/evaluate/mover_error.hpp"

#include <cmath>

#include "onboard/mapping/tree/key_at.hpp"
#include "onboard/report/figures/map_error.hpp"

namespace cairn::cli {
namespace {

std::optional<double> share_of(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

bool occupied(const mapping::SemanticOcTree& map, const mapping::SemanticNode* node) {
  return node != nullptr && map.isNodeOccupied(*node);
}

}  // namespace

std::optional<double> MoverError::static_accuracy() const { return share_of(kept, static_voxels); }
std::optional<double> MoverError::seen_static_accuracy() const { return share_of(seen_kept, seen_static_voxels); }
std::optional<double> MoverError::dynamic_accuracy() const { return share_of(dropped, mover_voxels); }

MoverTruth::MoverTruth(const mapping::SemanticOcTree& world, const SE3& T_world_map,
                       const mapping::MappingConfig& config)
    : world_(world),
      T_map_world_(T_world_map.inverse()),
      max_range_m_(config.max_range_m),
      reference_(config, workers_) {}

void MoverTruth::count(const TrueScan& scan) {
  for (const TrueScan::Return& r : scan.returns) {
    if (max_range_m_ >= 0 && r.range_m > max_range_m_) continue;
    const auto key = mapping::key_at(world_, r.point.cast<double>());
    if (!key) continue;
    Seen& seen = voxels_[*key];
    ++(r.class_id == kPersonId ? seen.people : seen.others);
  }
}

Result<void> MoverTruth::insert(const TrueScan& scan) {
  standing_.clear();
  for (const TrueScan::Return& r : scan.returns)
    if (r.class_id != kPersonId) standing_.push_back(r.point);
  const auto inserted = reference_.insert(standing_, scan.T_path_lidar.translation().cast<float>());
  if (!inserted) return inserted.error();
  return {};
}

bool MoverTruth::near_what_stands(const octomap::OcTreeKey& key) const {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const octomap::OcTreeKey there(static_cast<octomap::key_type>(key[0] + x),
                                       static_cast<octomap::key_type>(key[1] + y),
                                       static_cast<octomap::key_type>(key[2] + z));
        if (occupied(world_, world_.search(there))) return true;
      }
  return false;
}

void MoverTruth::judge_static(const mapping::SemanticOcTree& map, const Eigen::Vector3d& p_map,
                              MoverError& error) const {
  const double edge = map.getResolution();
  const bool kept = report::distance_to_occupied(map, p_map, std::sqrt(3.0) * edge).has_value();
  ++error.seen_static_voxels;
  error.seen_kept += kept ? 1 : 0;
  if (!report::distance_to_occupied(reference_.tree(), p_map, edge)) return;
  ++error.static_voxels;
  error.kept += kept ? 1 : 0;
}

MoverError MoverTruth::judge(const mapping::SemanticOcTree& map) const {
  MoverError error;
  for (const auto& [key, seen] : voxels_) {
    const octomap::point3d c = world_.keyToCoord(key);
    const Eigen::Vector3d p = T_map_world_ * Eigen::Vector3d(c.x(), c.y(), c.z());
    if (seen.others >= kLeastReturns && occupied(world_, world_.search(key))) judge_static(map, p, error);
    if (seen.people == 0 || near_what_stands(key)) continue;
    ++error.mover_voxels;
    if (!occupied(map, map.search(p.x(), p.y(), p.z()))) ++error.dropped;
  }
  return error;
}

}  // namespace cairn::cli
