// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/octomap.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "onboard/mapping/mapper.hpp"
#include "tests/onboard/mapping/scan_yard.hpp"
#include "tests/onboard/mapping/tree_compare.hpp"

namespace cairn::mapping {

/// Random and adversarial scans on octomap::OcTree and Mapper in lock step: rays along exact voxel borders and through
/// exact corners (ties in the ray march), repeated and empty rays, all sensor models, the edge of the key space, and
/// map sizes from one voxel to hundreds of metres. The seed says everything.
class ScanCase {
 public:
  explicit ScanCase(unsigned seed, int scans = 6) : random_(seed), scans_(scans) {
    const double resolutions[] = {0.05, 0.07, 0.1, 0.2, 0.25, 0.5, 1.0};
    config_.spare_surfaces = false;
    config_.resolution_m = resolutions[random_() % 7];
    if (random_() % 2 == 0) {
      config_.prob_hit = between(0.55, 0.95);
      config_.prob_miss = between(0.2, 0.49);
      config_.clamping_min = between(0.05, 0.4);
      config_.clamping_max = between(0.6, 0.98);
    }
    at_edge_ = random_() % 5 == 0;
    spread_ = config_.resolution_m * (random_() % 2 == 0 ? 60 : 8) * static_cast<double>(1 + random_() % 3);
    config_.max_range_m = !at_edge_ && random_() % 3 == 0 ? -1.0 : between(0.1, 1.2) * spread_;
    const double end = 32768 * config_.resolution_m;
    centre_ = {at_edge_ ? end - 3 * config_.resolution_m : between(-50, 50),
               at_edge_ && random_() % 2 == 0 ? -end + 2 * config_.resolution_m : between(-50, 50), between(-5, 5)};
  }

  /// Empty when the trees are equal after every scan; otherwise what differs.
  std::string run(unsigned threads) {
    Workers workers(threads);
    Mapper mapper(config_, workers);
    octomap::OcTree stock(config_.resolution_m);
    set_model(stock);
    for (int i = 0; i < scans_; ++i) {
      const MapScan scan = next_scan();
      if (!mapper.insert(scan.points, scan.origin)) return "scan " + std::to_string(i) + " was refused";
      stock.insertPointCloud(accepted(scan, stock), {scan.origin.x(), scan.origin.y(), scan.origin.z()},
                             config_.max_range_m, false, true);
      if (const std::size_t n = differing_nodes(mapper.tree(), stock); n != 0)
        return "scan " + std::to_string(i) + ": " + std::to_string(n) + " nodes differ";
    }
    return data_of(mapper.tree()) == data_of(stock) ? "" : "writeData() differs";
  }

 private:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  void set_model(octomap::OcTree& tree) const {
    tree.setProbHit(config_.prob_hit);
    tree.setProbMiss(config_.prob_miss);
    tree.setClampingThresMin(config_.clamping_min);
    tree.setClampingThresMax(config_.clamping_max);
  }

  MapScan next_scan() {
    const double r = config_.resolution_m;
    const bool lattice = random_() % 3 == 0;
    Eigen::Vector3d origin =
        centre_ + Eigen::Vector3d(between(-1, 1), between(-1, 1), between(-1, 1)) * std::min(1.0, 2 * r);
    if (lattice)
      for (double& x : origin) x = std::floor(x / r) * r + (random_() % 2 == 0 ? 0.5 * r : 0.0);
    MapScan scan{{}, origin.cast<float>()};
    for (std::size_t n = random_() % 300; n > 0; --n) {
      Eigen::Vector3d p = origin + Eigen::Vector3d(between(-1, 1), between(-1, 1), between(-0.3, 0.3)) * spread_;
      if (lattice)
        for (int a = 0; a < 3; ++a) p[a] = origin[a] + std::round((p[a] - origin[a]) / r) * r;
      if (random_() % 7 == 0) p[static_cast<int>(random_() % 3)] = origin[0];
      if (random_() % 9 == 0) p = origin;
      scan.points.insert(scan.points.end(), random_() % 4 == 0 ? 2 : 1, p.cast<float>());
    }
    return scan;
  }

  /// OctoMap wraps points outside of the map to its other side; Mapper leaves them out.
  static octomap::Pointcloud accepted(const MapScan& scan, const octomap::OcTree& tree) {
    octomap::Pointcloud cloud;
    octomap::OcTreeKey key;
    for (const Eigen::Vector3f& p : scan.points)
      if (tree.coordToKeyChecked(octomap::point3d(p.x(), p.y(), p.z()), key)) cloud.push_back(p.x(), p.y(), p.z());
    return cloud;
  }

  std::mt19937 random_;
  int scans_;
  MappingConfig config_;
  bool at_edge_ = false;
  double spread_ = 1.0;
  Eigen::Vector3d centre_;
};

}  // namespace cairn::mapping
