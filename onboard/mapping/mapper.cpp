// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/mapper.hpp"

#include <octomap/Pointcloud.h>

#include <utility>

namespace cairn {

Mapper::Mapper(const MappingConfig& config, Workers& workers)
    : config_(config), workers_(workers), tree_(config.resolution_m) {
  tree_.setProbHit(config.prob_hit);
  tree_.setProbMiss(config.prob_miss);
  tree_.setClampingThresMin(config.clamping_min);
  tree_.setClampingThresMax(config.clamping_max);
  tree_.reserve_bytes(static_cast<std::size_t>(config.reserve_mb) << 20U);
}

Mapper::~Mapper() = default;

Result<InsertReport> Mapper::insert(std::span<const Eigen::Vector3f> points_map, const Eigen::Vector3f& origin_map) {
  InsertReport report;
  report.points = points_map.size();
  octomap::Pointcloud cloud;
  for (const Eigen::Vector3f& p : points_map) {
    octomap::OcTreeKey key;
    if (!p.allFinite())
      ++report.not_finite;
    else if (!tree_.coordToKeyChecked(octomap::point3d(p.x(), p.y(), p.z()), key))
      ++report.outside_map;
    else
      cloud.push_back(p.x(), p.y(), p.z());
  }
  (void)workers_;
  tree_.insertPointCloud(cloud, {origin_map.x(), origin_map.y(), origin_map.z()}, config_.max_range_m, false, true);
  return report;
}

std::vector<TileKey> Mapper::take_changed_tiles() { return std::exchange(changed_, {}); }

}  // namespace cairn
