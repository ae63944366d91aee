// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
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
  std::shared_ptr<const mapping::SemanticOcTree> a, b;
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
inline std::unique_ptr<mapping::SemanticOcTree> stretch_map(const Scene& scene, const Stretch& stretch,
                                                            const SE3& T_map_world, unsigned seed, double resolution_m,
                                                            double range_m) {
  Vector6 mount;
  mount << 0.2, 0, 0.6, 0, 0, 0;
  const SE3 T_base_lidar = SE3::from_xyz_rpy(mount);
  Vlp16 lidar(T_base_lidar, 0.02, seed);
  Workers workers(1);
  mapping::MappingConfig config;
  config.resolution_m = resolution_m;
  config.max_range_m = range_m;
  mapping::Mapper mapper(config, workers);
  for (int i = 0; i < stretch.scans; ++i) {
    const SE3 at = pose_on(scene.ride, stretch.from + (stretch.to - stretch.from) * i / stretch.scans);
    const Scan scan = lidar.scan(
        scene.world, [&](double) { return at; }, 0);
    const SE3 T_map_lidar = T_map_world * at * T_base_lidar;
    std::vector<Eigen::Vector3f> points;
    for (const Eigen::Vector3f& p : scan.cloud.xyz) points.emplace_back((T_map_lidar * p.cast<double>()).cast<float>());
    (void)mapper.insert(points, T_map_lidar.translation().cast<float>());
  }
  auto map = std::make_unique<mapping::SemanticOcTree>(mapper.tree());
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

}  // namespace cairn::support
