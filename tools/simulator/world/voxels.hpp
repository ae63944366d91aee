// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/octomap.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// The true map of a world, as a mapper with perfect sensors could know it:
///   occupied  voxels that a surface passes through (exact triangle–cube overlap),
///   free      voxels without surface that are connected with the robots' surroundings through voxel faces,
///   unknown   the rest: the inside of walls, furniture and the ground, and all beyond the bounds of the mesh.
class Voxels {
 public:
  enum State : std::uint8_t { kUnknown = 0, kFree = 1, kOccupied = 2 };

  /// `resolution` is an edge in metres; `seeds` are points in free space, such as the robots' starts.
  Voxels(const World& world, double resolution, std::span<const Eigen::Vector3d> seeds);

  [[nodiscard]] State at(const Eigen::Vector3d& p) const;
  /// Log-odds at OctoMap's default clamping limits: occupied 3.5, free −2. Equal neighbours are pruned.
  [[nodiscard]] std::unique_ptr<octomap::OcTree> to_octree() const;

 private:
  void mark(const Triangle& triangle);
  void flood(std::span<const Eigen::Vector3d> seeds);
  [[nodiscard]] State* row(int y, int z);  // null outside
  [[nodiscard]] Eigen::Vector3i cell(const Eigen::Vector3d& p) const;
  [[nodiscard]] bool inside(const Eigen::Vector3i& c) const;
  [[nodiscard]] std::size_t index(const Eigen::Vector3i& c) const;

  double resolution_;
  Eigen::Vector3i first_;  ///< lowest voxel, counted from the origin of the world as OctoMap counts
  Eigen::Vector3i size_;
  std::vector<State> state_;
};

}  // namespace cairn::simulator
