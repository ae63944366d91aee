// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "tools/simulator/world/mesh.hpp"

namespace cairn::simulator {

/// Heights above the ground in metres.
struct FlightHeights {
  double low = 1.0, high = 1.7;
};

/// A place to drive in. The same scene is the same world in every run; only what robots do in it depends on the seed.
/// z up; x and y along the building.
struct World {
  std::string name;
  Mesh mesh;
  Eigen::AlignedBox3d bounds;                    ///< of the mesh
  bool open_air = false;                         ///< sun and sky instead of lamps
  FlightHeights flight;                          ///< where robots that fly do so
  Eigen::Vector3d inner_size{0, 0, 0};           ///< clear length, width, height of the hall, building or plot
  std::vector<Eigen::Vector2d> places;           ///< where robots may start and go
  std::function<double(double, double)> ground;  ///< height of what the wheels stand on, smooth in x and y
};

}  // namespace cairn::simulator
