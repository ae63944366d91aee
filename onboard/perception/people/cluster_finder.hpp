// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "onboard/perception/people/ground_grid.hpp"

namespace cairn::people {

/// Points that stand together on the ground and are as large as a person.
struct Cluster {
  Eigen::Vector2f centre = Eigen::Vector2f::Zero();  ///< odom, m: of the body, behind the side that was seen
  float ground = 0;                                  ///< z of the ground there, odom
  float top = 0;                                     ///< m above the ground, of the points
  float extent = 0;                                  ///< m, the larger horizontal one
  std::uint32_t points = 0;
};

/// A scan → clusters. Points above the ground are put into cells of 0.12 m; cells that touch belong together. Memory is
/// reused. The result does not depend on the order of the points but for the order of sums.
class ClusterFinder {
 public:
  explicit ClusterFinder(double farthest_m);

  /// Points in odom, metres, z up. Valid until the next call.
  const std::vector<Cluster>& find(std::span<const Eigen::Vector3f> points_odom, const Eigen::Vector3f& sensor_odom,
                                   float sensor_height_m);
  [[nodiscard]] const GroundGrid& ground() const { return ground_; }
  /// Of the last scan: height above the ground of each point; 0 where it is too far.
  [[nodiscard]] std::span<const float> heights() const { return heights_; }

 private:
  struct Body;                           // cells that touch
  static constexpr float kCell = 0.12F;  // m
  void fill_cells(std::span<const Eigen::Vector3f> points_odom, const Eigen::Vector3f& sensor_odom);
  void flood(std::uint32_t first, std::span<const Eigen::Vector3f> points_odom, Body& body);
  void visit(std::uint32_t cell, std::span<const Eigen::Vector3f> points_odom, Body& body);

  float farthest_;  // m
  int side_;        // cells
  GroundGrid ground_;
  std::vector<float> heights_;
  std::vector<std::uint32_t> head_;  // of each cell: its last point + 1; 0: none, or visited
  std::vector<std::uint32_t> next_;  // of each point: the one before in its cell + 1
  std::vector<std::uint32_t> filled_, open_;
  std::vector<Cluster> clusters_;
};

}  // namespace cairn::people
