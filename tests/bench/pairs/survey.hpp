// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/mapping/tree/semantic_octree.hpp"
#include "tools/simulator/world/tracer.hpp"
#include "tools/simulator/world/world.hpp"

namespace cairn::pairs {

/// A world and what traces rays in it.
struct Ground {
  explicit Ground(simulator::World w);

  simulator::World world;
  simulator::Tracer tracer;
};

/// How a robot maps.
struct Survey {
  SE3 T_map_world;
  double voxel_m = 0.1, range_m = 12;
  double dropped = 0.2;   ///< share of the occupied voxels that are missing
  bool mirrored = false;  ///< the map is of the world's mirror image
  std::uint64_t seed = 0;
};

/// The map of a robot that takes two scans of sixteen lasers at each stop. Ranges err by 2 cm, and poses by 2 cm and
/// 0.1 degrees (standard deviations).
[[nodiscard]] std::unique_ptr<mapping::SemanticOcTree> survey(const Ground& ground,
                                                              std::span<const Eigen::Vector2d> stops,
                                                              const Survey& how);

}  // namespace cairn::pairs
