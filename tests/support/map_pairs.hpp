// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "hal/workers.hpp"
#include "onboard/mapping/mapper.hpp"
#include "tests/support/scenes.hpp"

namespace cairn::support {

/// Two maps of one place and where b's frame lies in a's.
struct MapPair {
  std::string name;
  std::unique_ptr<SemanticOcTree> a, b;
  SE3 T_a_b;
};

/// A stretch of a scene's ride: from one parameter of its curve to another.
struct Stretch {
  double from = 0, to = 3;
  int scans = 24;
};

inline SE3 pose_on(const Ride& ride, double phi) {
  const Eigen::Vector2d p = ride.curve(phi), ahead = ride.curve(phi + 1e-3);
  Vector6 v;
  v << p.x(), p.y(), ride.ground(p.x(), p.y()), 0, 0, std::atan2(ahead.y() - p.y(), ahead.x() - p.x());
  return SE3::from_xyz_rpy(v);
}

/// The map of a robot that stops along a stretch and takes a scan each time; poses are exact, ranges have 2 cm noise.
inline std::unique_ptr<SemanticOcTree> stretch_map(const Scene& scene, const Stretch& stretch, const SE3& T_map_world,
                                                   unsigned seed, double resolution_m, double range_m) {
  Vector6 mount;
  mount << 0.2, 0, 0.6, 0, 0, 0;
  const SE3 T_base_lidar = SE3::from_xyz_rpy(mount);
  Vlp16 lidar(T_base_lidar, 0.02, seed);
  Workers workers(1);
  MappingConfig config;
  config.resolution_m = resolution_m;
  config.max_range_m = range_m;
  Mapper mapper(config, workers);
  for (int i = 0; i < stretch.scans; ++i) {
    const SE3 at = pose_on(scene.ride, stretch.from + (stretch.to - stretch.from) * i / stretch.scans);
    const Scan scan = lidar.scan(
        scene.world, [&](double) { return at; }, 0);
    const SE3 T_map_lidar = T_map_world * at * T_base_lidar;
    std::vector<Eigen::Vector3f> points;
    for (const Eigen::Vector3f& p : scan.cloud.xyz) points.emplace_back((T_map_lidar * p.cast<double>()).cast<float>());
    (void)mapper.insert(points, T_map_lidar.translation().cast<float>());
  }
  auto map = std::make_unique<SemanticOcTree>(mapper.tree());
  map->canonicalise();
  return map;
}

/// Two robots in one scene; a's frame is that of its start turned by 0.7 rad, b's turned by `yaw`. A floor or wall that
/// lies along the axes of a grid looks up to half a voxel off, whatever is done with the map; both frames have the
/// floor at the same height, as ground robots' have, and no wall along their axes.
inline MapPair two_robots(const Scene& scene, const Stretch& of_a, const Stretch& of_b, unsigned seed, double yaw = 2.0,
                          double resolution_m = 0.1, double range_m = 10) {
  const auto frame = [](double turn, const SE3& T_world_start) {
    Vector6 turned;
    turned << 0.037, -0.021, 0.03, 0, 0, turn;
    return SE3::from_xyz_rpy(turned) * T_world_start.inverse();
  };
  const SE3 T_a_world = frame(0.7, pose_on(scene.ride, of_a.from)),
            T_b_world = frame(yaw, pose_on(scene.ride, of_b.from));
  return {scene.name, stretch_map(scene, of_a, T_a_world, seed, resolution_m, range_m),
          stretch_map(scene, of_b, T_b_world, seed + 1, resolution_m, range_m), T_a_world * T_b_world.inverse()};
}

/// A degraded copy of those parts of a map that `inside` holds (points in the map's frame, m), in another frame and at
/// another resolution: `dropped` of the voxels are missing, each is moved by up to half a voxel, probabilities are
/// drawn from 0.7…0.97. Free space is carried over as it is.
struct Degrading {
  double resolution_m = 0.1, dropped = 0.2;
  unsigned seed = 1;
};

inline std::unique_ptr<SemanticOcTree> degraded(const SemanticOcTree& whole, const SE3& T_copy_whole,
                                                const std::function<bool(const Eigen::Vector3d&)>& inside,
                                                const Degrading& options) {
  auto copy = std::make_unique<SemanticOcTree>(options.resolution_m);
  std::mt19937 random(options.seed);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const auto set = [&](const Eigen::Vector3d& p, float log_odds, bool over) {
    const octomap::point3d q(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
    if (over || copy->search(q) == nullptr) copy->setNodeValue(q, log_odds, true);
  };
  const double edge = whole.getResolution(), r = options.resolution_m;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (auto leaf = whole.begin_leafs(), end = whole.end_leafs(); leaf != end; ++leaf) {
    const auto n = static_cast<int>(std::lround(leaf.getSize() / edge));
    const Eigen::Vector3d corner(leaf.getX() - leaf.getSize() / 2, leaf.getY() - leaf.getSize() / 2,
                                 leaf.getZ() - leaf.getSize() / 2);
    for (int i = 0; i < n * n * n; ++i) {
      const Eigen::Vector3d at = corner + edge * (Eigen::Vector3d(i % n, i / n % n, i / n / n).array() + 0.5).matrix();
      if (!inside(at)) continue;
      const Eigen::Vector3d moved = T_copy_whole * at;
      low = low.cwiseMin(moved);
      high = high.cwiseMax(moved);
      if (!whole.isNodeOccupied(*leaf) || uniform() < options.dropped) continue;
      const Eigen::Vector3d jitter(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5);
      const double p = 0.7 + 0.27 * uniform();
      set(T_copy_whole * (at + edge * jitter), static_cast<float>(std::log(p / (1 - p))), true);
    }
  }
  const SE3 T_whole_copy = T_copy_whole.inverse();
  for (double x = std::floor(low.x() / r) * r; x < high.x(); x += r)
    for (double y = std::floor(low.y() / r) * r; y < high.y(); y += r)
      for (double z = std::floor(low.z() / r) * r; z < high.z(); z += r) {
        const Eigen::Vector3d centre = Eigen::Vector3d(x, y, z).array() + r / 2, at = T_whole_copy * centre;
        if (!inside(at)) continue;
        const auto* node = whole.search(at.x(), at.y(), at.z());
        if (node != nullptr && !whole.isNodeOccupied(node)) set(centre, -1.5F, false);
      }
  copy->canonicalise();
  return copy;
}

/// A map cut in two along its longer side; the halves share `overlap` of each. b has a frame of its own.
inline MapPair halves(const SemanticOcTree& whole, std::string name, double overlap, double yaw, unsigned seed,
                      double resolution_m = 0.1) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (auto leaf = whole.begin_leafs(), end = whole.end_leafs(); leaf != end; ++leaf) {
    if (!whole.isNodeOccupied(*leaf)) continue;
    const Eigen::Vector3d p(leaf.getX(), leaf.getY(), leaf.getZ());
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const int axis = high.x() - low.x() > high.y() - low.y() ? 0 : 1;
  const double length = high[axis] - low[axis], half = length / (2 - overlap);
  const auto in_a = [=](const Eigen::Vector3d& p) { return p[axis] < low[axis] + half; };
  const auto in_b = [=](const Eigen::Vector3d& p) { return p[axis] >= high[axis] - half; };
  Vector6 frame;
  frame << 0.5 * (low.x() + high.x()) + 0.037, 0.5 * (low.y() + high.y()) - 0.021, low.z() + 1.013, 0, 0, yaw;
  frame[axis] = high[axis] - half / 2 + 0.037;
  const SE3 T_a_b = SE3::from_xyz_rpy(frame);
  return {std::move(name), degraded(whole, {}, in_a, {resolution_m, 0.2, seed}),
          degraded(whole, T_a_b.inverse(), in_b, {resolution_m, 0.2, seed + 1}), T_a_b};
}

}  // namespace cairn::support
