// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/ColorOcTree.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tools/simulator/world/tracer.hpp"
#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// The true map of a world, as a mapper with perfect sensors could know it:
///   occupied  voxels that a surface passes through (exact triangle–cube overlap),
///   free      voxels without surface that are connected with the robots' surroundings through voxel faces,
///   unknown   the rest: the inside of walls, furniture and the ground, and all beyond the bounds of the mesh.
/// The class of an occupied voxel is that of the materials of which most can be seen inside of it: area times openness.
class Voxels {
 public:
  enum State : std::uint8_t { kUnknown = 0, kFree = 1, kOccupied = 2 };

  /// `resolution` is an edge in metres; `seeds` are points in free space, such as the robots' starts. `tracer`, of the
  /// world, is used here only. Without it the area alone decides on the class, covered or not.
  Voxels(const World& world, double resolution, std::span<const Eigen::Vector3d> seeds, const Tracer* tracer = nullptr);

  [[nodiscard]] State at(const Eigen::Vector3d& p) const;
  /// The trainId of an occupied voxel; kIgnoredClass where it has none, and everywhere else.
  [[nodiscard]] std::uint8_t class_at(const Eigen::Vector3d& p) const;
  /// Log-odds at OctoMap's default clamping limits: occupied 3.5, free −2. The colours are those of the classes, white
  /// for none. Neighbours that are equal in both are pruned.
  [[nodiscard]] std::unique_ptr<octomap::ColorOcTree> to_octree() const;

 private:
  /// The area, m², of one triangle in a voxel.
  struct Share {
    std::uint32_t voxel;
    std::uint8_t class_id;
    float area;
    std::uint32_t triangle;  ///< of the mesh
  };
  void mark(const Mesh& mesh, std::uint32_t triangle, std::vector<Share>& shares);
  void classify(std::vector<Share> shares, const Mesh& mesh, const Tracer* tracer);
  void leave_to_the_seen(std::span<Share> shares, const Mesh& mesh, const Tracer& tracer) const;
  [[nodiscard]] static std::uint8_t largest_class(std::span<const Share> shares);  // ordered by class
  [[nodiscard]] Eigen::Vector3d centre_of(std::uint32_t voxel) const;
  void flood(std::span<const Eigen::Vector3d> seeds);
  [[nodiscard]] State* row(int y, int z);  // null outside
  [[nodiscard]] Eigen::Vector3i cell(const Eigen::Vector3d& p) const;
  [[nodiscard]] bool inside(const Eigen::Vector3i& c) const;
  [[nodiscard]] std::size_t index(const Eigen::Vector3i& c) const;

  double resolution_;
  Eigen::Vector3i first_;  ///< lowest voxel, counted from the origin of the world as OctoMap counts
  Eigen::Vector3i size_;
  std::vector<State> state_;
  std::vector<std::uint8_t> class_;  ///< as class_at()
};

}  // namespace cairn::simulator
