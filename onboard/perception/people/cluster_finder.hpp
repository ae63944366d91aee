// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "onboard/perception/people/body.hpp"
#include "onboard/perception/people/ground_grid.hpp"
#include "onboard/perception/people/space.hpp"
#include "onboard/perception/people/wall_cells.hpp"

namespace cairn::people {

/// Points that stand together on the ground and are as large as a person, or as a person's legs.
struct Cluster {
  Eigen::Vector2f centre = Eigen::Vector2f::Zero();  ///< odom, m: of the body, behind the side that was seen
  float ground = 0;                                  ///< z of the ground there, odom
  float top = 0;                                     ///< m above the ground, of the points
  float extent = 0;                                  ///< m, the larger horizontal one
  std::uint32_t points = 0;
  float entered = 0;     ///< share of the points in places that were free before
  float known = 0;       ///< share of the points in places where something was before
  bool upright = false;  ///< as high and as wide as somebody who stands, and well seen
  bool low = false;      ///< too low for a person: legs, if something hides the rest
  float passed = 0;      ///< share of the rays that go on behind it, see ScanRays; ClusterFinder leaves it at 0

  /// Too much goes through it for a person. Of bodies within 7 m that came into free places, 1 to 5 % of people's were
  /// so in three simulated drives, and three quarters of a forest's bushes or more.
  [[nodiscard]] bool porous() const { return passed > 0.5F; }
  /// It stands alone. Who is seen beside something else has no points of their own.
  [[nodiscard]] bool alone() const { return points > 0; }
};

/// Which points make clusters.
struct ClusterChoice {
  std::span<const Space> spaces;           ///< of each point; empty: nothing is known of any
  bool loose = false;                      ///< those in settled places are left out
  std::span<const Eigen::Vector2d> seeds;  ///< where people are expected: a wide body is parted among them
};

/// A scan → clusters. Points above the ground are put into cells of 0.12 m; cells that touch belong together. Memory is
/// reused. The result does not depend on the order of the points but for the order of sums.
class ClusterFinder {
 public:
  explicit ClusterFinder(double farthest_m);

  /// How high the points of a scan are above the ground: first of all. Points in odom, metres, z up.
  void measure(std::span<const Eigen::Vector3f> points_odom, const Eigen::Vector3f& sensor_odom, float sensor_height_m);
  /// The clusters of the scan that was measured; low ones only with a loose choice. Valid until the next call.
  const std::vector<Cluster>& find(std::span<const Eigen::Vector3f> points_odom, const ClusterChoice& choice = {});
  /// z of the ground at a place of odom, in the last scan.
  [[nodiscard]] float ground_at(const Eigen::Vector2f& place_odom) {
    return ground_.height(place_odom.x(), place_odom.y());
  }
  /// Of the last scan: height above the ground of each point; 0 where it is too far.
  [[nodiscard]] std::span<const float> heights() const { return heights_; }
  /// Whether a point of the last scan is on a straight wall, see WallCells. Only points that may be somebody's are.
  [[nodiscard]] bool on_wall(const Eigen::Vector3f& point_odom, std::size_t i) const {
    return at_body_height(i) && walls_.is_wall(cell_of(point_odom));
  }
  [[nodiscard]] bool at_body_height(std::size_t i) const { return heights_[i] > kShin && heights_[i] < kHead; }
  /// Of the last loose choice: the points between shin and head that may be somebody's.
  [[nodiscard]] std::span<const std::uint8_t> loose() const { return loose_; }

 private:
  struct Body;                           // cells that touch
  static constexpr float kCell = 0.12F;  // m
  void fill_cells(std::span<const Eigen::Vector3f> points_odom, const ClusterChoice& choice);
  void mark_standing(std::span<const Eigen::Vector3f> points_odom, std::span<const Space> spaces);
  [[nodiscard]] bool beside_standing(std::uint32_t cell, Space space) const;
  void put(std::uint32_t point, std::uint32_t cell);
  void flood(std::uint32_t first);
  void visit(std::uint32_t cell);
  [[nodiscard]] std::uint32_t cell_of(const Eigen::Vector3f& point) const;
  [[nodiscard]] Body body_of(std::span<const std::uint32_t> members, std::span<const Eigen::Vector3f> points_odom,
                             const ClusterChoice& choice) const;
  static bool is_upright(const Body& body, float seen_up_to);
  void add_if_person_sized(const Body& body);
  void add_low(const Body& body);
  void join_low();
  void part(std::span<const Eigen::Vector3f> points_odom, const ClusterChoice& choice, const Body& whole);

  float farthest_;  // m
  int side_;        // cells
  GroundGrid ground_;
  WallCells walls_;
  Eigen::Vector3f sensor_ = Eigen::Vector3f::Zero();
  float sensor_height_ = 0;
  std::vector<float> heights_;
  std::vector<std::uint8_t> loose_;
  std::vector<std::uint32_t> head_;      // of each cell: its last point + 1; 0: none, or visited
  std::vector<std::uint32_t> next_;      // of each point: the one before in its cell + 1
  std::vector<std::uint32_t> standing_;  // of each cell: points that have long stood there
  std::vector<std::uint32_t> filled_, open_, standing_cells_;
  std::vector<std::uint32_t> members_;               // points of the body that is flooded
  std::vector<std::vector<std::uint32_t>> of_seed_;  // reused
  std::vector<Cluster> clusters_;
  std::vector<Cluster> low_;  // of a loose choice
};

}  // namespace cairn::people
