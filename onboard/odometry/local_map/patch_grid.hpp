// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "onboard/odometry/local_map/huge_pages.hpp"
#include "onboard/odometry/local_map/patch.hpp"

namespace cairn::odometry {

/// Integer coordinates of a block.
struct BlockIndex {
  std::int32_t x, y, z;
  friend bool operator==(const BlockIndex&, const BlockIndex&) = default;
};

/// A sparse grid of cubic blocks, each with the moments of its points and the patch fitted to them.
/// Block i covers [i·edge, (i+1)·edge), or [(i−½)·edge, (i+½)·edge) when the grid is staggered.
///
/// A block has a front and, once it holds a plane that is then seen from behind, a back: the two
/// faces of a thin wall are two planes.
///
/// Open addressing over dense arrays, all reserved at construction: adding, fitting and removing
/// never allocate. What is in the grid, and in which order, depends only on the sequence of calls.
class PatchGrid {
 public:
  /// Bounds on memory.
  struct Limits {
    std::size_t blocks;   ///< further blocks are refused
    float points;         ///< per block; further points are ignored, which keeps old patches where they are
    float lasting_s = 0;  ///< a block's patches are lasting from so long after its first point
  };
  /// Where the sensor is while points are added, in odom, and when that is.
  struct Sensor {
    Eigen::Vector3d position;
    Eigen::Vector3f up;
    float time_s = 0;  ///< since the map began
  };
  PatchGrid(float edge, bool staggered, const Limits& limits);

  /// A point that was seen then, in seconds since the map began.
  struct Seen {
    float epoch = 0;
    float time_s = 0;
  };
  /// `to_sensor` points from p to the sensor.
  void add(const BlockIndex& at, const Eigen::Vector3d& p, const Eigen::Vector3f& to_sensor, const Seen& when);
  /// Fits the blocks that have grown by a quarter since their last fit. To be called after adding.
  void refit(const PatchCriteria& criteria, const Sensor& sensor);
  /// Forgets the blocks whose centre is farther than `radius` from `centre`.
  void keep_within(const Eigen::Vector3d& centre, double radius);
  void clear();

  /// The block's patch as seen from a sensor in direction `to_sensor`, or null when there is none.
  [[nodiscard]] const Patch* find(const BlockIndex& at, const Eigen::Vector3f& to_sensor) const {
    for (const Side side : {kFront, kBack}) {
      const std::uint32_t block = slots_[slot_of(at, side)].block;
      if (block == kNone) return nullptr;
      const Patch& patch = patches_[block];
      if (!seen_from_behind(patch, to_sensor)) return patch.kind == Patch::Kind::kNone ? nullptr : &patch;
    }
    return nullptr;
  }
  /// Moments of the block's front, or null.
  [[nodiscard]] const Moments* moments(const BlockIndex& at) const {
    const std::uint32_t block = slots_[slot_of(at, kFront)].block;
    return block == kNone ? nullptr : &moments_[block];
  }
  [[nodiscard]] Eigen::Vector3d centre(const BlockIndex& at) const {
    return edge_ * (Eigen::Vector3d(at.x, at.y, at.z).array() + half_);
  }

  /// Calls `visit(index, moments of one side)` for all blocks, in the order in which they were made.
  template <class Visit>
  void for_each_block(Visit&& visit) const {
    for (std::size_t i = 0; i < index_.size(); ++i) visit(index_[i], moments_[i]);
  }

  [[nodiscard]] double edge() const { return edge_; }
  [[nodiscard]] std::size_t size() const { return index_.size(); }
  [[nodiscard]] std::size_t capacity() const { return limits_.blocks; }
  [[nodiscard]] std::size_t patches() const;

 private:
  enum Side : std::uint8_t { kFront, kBack };
  static constexpr std::uint32_t kNone = UINT32_MAX;
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t block = kNone;
  };

  static bool seen_from_behind(const Patch& patch, const Eigen::Vector3f& to_sensor) {
    // A sensor almost in the plane may appear on the wrong side by noise.
    constexpr float kMargin_m = 0.05F;
    return patch.kind == Patch::Kind::kPlane && patch.normal.direction.dot(to_sensor) < -kMargin_m;
  }
  static std::uint64_t key_of(const BlockIndex& at, Side side);
  [[nodiscard]] std::size_t slot_of(const BlockIndex& at, Side side) const;
  std::uint32_t find_or_make(const BlockIndex& at, Side side, float time_s);
  void rehash();

  double edge_;
  double half_;  // centre of block 0 in blocks: ½, or 0 when staggered
  Limits limits_;
  HugePageVector<Slot> slots_;
  std::vector<BlockIndex> index_;  // dense, in order of creation, like the arrays below
  std::vector<Side> side_;
  HugePageVector<Moments> moments_;
  HugePageVector<Patch> patches_;
  std::vector<float> first_s_;        // when the block's first point was seen
  std::vector<float> fitted_;         // count at the last fit; negative while the block waits for the next
  std::vector<std::uint32_t> grown_;  // blocks to be fitted
};

}  // namespace cairn::odometry
