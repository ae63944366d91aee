// SPDX-License-Identifier: Apache-2.0
#include "onboard/report/figures/map_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "onboard/mapping/files/point_file.hpp"

namespace cairn::report {
namespace {

/// A node and the cube it stands for.
struct Cube {
  const mapping::SemanticNode* node;
  Eigen::Vector3d centre;
  double half;
};

/// To the nearest voxel centre that the cube may hold.
double distance(const Cube& cube, const Eigen::Vector3d& point, double voxel) {
  const Eigen::Array3d beyond = (point - cube.centre).array().abs() - (cube.half - voxel / 2);
  return beyond.max(0).matrix().norm();
}

Cube child_of(const Cube& cube, unsigned i) {
  const double quarter = cube.half / 2;
  const Eigen::Vector3d step((i & 1) != 0 ? quarter : -quarter, (i & 2) != 0 ? quarter : -quarter,
                             (i & 4) != 0 ? quarter : -quarter);
  return {cube.node->block() + i, cube.centre + step, quarter};
}

std::optional<double> ratio(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

void measure_accuracy(const mapping::SemanticOcTree& map, const mapping::SemanticOcTree& truth,
                      const MapErrorOptions& options, MapError& error) {
  double sum = 0, sum2 = 0;
  mapping::for_each_occupied_voxel(map, [&](const Eigen::Vector3f& v) {
    const Eigen::Vector3d point = options.T_truth_map * v.cast<double>();
    const double d = distance_to_occupied(truth, point, options.max_distance_m).value_or(options.max_distance_m);
    error.correct += d <= options.tolerance_m ? 1 : 0;
    sum += d;
    sum2 += d * d;
  });
  if (error.occupied == 0) return;
  error.mean_m = sum / static_cast<double>(error.occupied);
  error.rmse_m = std::sqrt(sum2 / static_cast<double>(error.occupied));
}

void measure_completeness(const mapping::SemanticOcTree& map, const mapping::SemanticOcTree& truth,
                          const MapErrorOptions& options, MapError& error) {
  const SE3 T_map_truth = options.T_truth_map.inverse();
  mapping::for_each_occupied_voxel(truth, [&](const Eigen::Vector3f& v) {
    const Eigen::Vector3d p = T_map_truth * v.cast<double>();
    if (distance_to_occupied(map, p, options.tolerance_m)) {
      ++error.found;
    } else {
      ++(map.search(p.x(), p.y(), p.z()) != nullptr ? error.contradicted : error.unseen);
    }
  });
}

}  // namespace

std::optional<double> distance_to_occupied(const mapping::SemanticOcTree& map, const Eigen::Vector3d& point,
                                           double max_distance_m) {
  const double voxel = map.getResolution();
  double best = max_distance_m;
  bool found = false;
  std::vector<Cube> open;
  if (map.getRoot() != nullptr)
    open.push_back({map.getRoot(), Eigen::Vector3d::Zero(), voxel * (1 << (mapping::SemanticOcTree::kDepth - 1))});
  while (!open.empty()) {
    const Cube cube = open.back();
    open.pop_back();
    const double d = distance(cube, point, voxel);
    if (d > best || !map.isNodeOccupied(cube.node)) continue;
    if (cube.node->block() == nullptr) {
      best = d;
      found = true;
      continue;
    }
    const std::size_t first = open.size();
    for (unsigned i = 0; i < mapping::SemanticNode::kChildren; ++i)
      if (cube.node->block()[i].present()) open.push_back(child_of(cube, i));
    // The nearest child comes last and so is taken first.
    std::sort(open.begin() + static_cast<std::ptrdiff_t>(first), open.end(),
              [&](const Cube& a, const Cube& b) { return distance(a, point, voxel) > distance(b, point, voxel); });
  }
  return found ? std::optional(best) : std::nullopt;
}

std::optional<double> MapError::precision() const { return ratio(correct, occupied); }
std::optional<double> MapError::recall() const { return ratio(found, found + contradicted); }

Result<MapError> map_error(const mapping::SemanticOcTree& map, const mapping::SemanticOcTree& truth,
                           const MapErrorOptions& asked) {
  MapErrorOptions options = asked;
  if (options.tolerance_m <= 0) options.tolerance_m = std::sqrt(3.0) * map.getResolution();
  options.max_distance_m = std::max(options.max_distance_m, options.tolerance_m);
  const auto voxels = mapping::listable_voxels(map), true_voxels = mapping::listable_voxels(truth);
  if (!voxels) return voxels.error();
  if (!true_voxels) return true_voxels.error();
  MapError error;
  error.occupied = *voxels;
  error.true_occupied = *true_voxels;
  measure_accuracy(map, truth, options, error);
  measure_completeness(map, truth, options, error);
  return error;
}

}  // namespace cairn::report
