// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "onboard/odometry/plane.hpp"

namespace cairn {

/// Integer coordinates of a block.
struct BlockIndex {
  std::int32_t x, y, z;
  friend bool operator==(const BlockIndex&, const BlockIndex&) = default;
};

/// A sparse grid of cubic blocks, each with the moments of its points and the plane fitted to them. Block i covers
/// [i·edge, (i+1)·edge), or [(i−½)·edge, (i+½)·edge) when the grid is staggered.
///
/// Open addressing over dense arrays, all reserved at construction: adding, fitting and removing never allocate. What
/// is in the grid, and in which order, depends only on the sequence of calls.
class PlaneGrid {
 public:
  struct Limits {
    std::size_t blocks;  ///< further blocks are refused
    float points;        ///< per block; further points are ignored, so that old planes stay where they are
  };
  PlaneGrid(float edge, bool staggered, const Limits& limits);

  void add(const BlockIndex& at, const Eigen::Vector3d& p, float epoch);
  /// Fits the blocks that have grown by a quarter since their last fit. To be called after adding.
  void refit(const PlaneCriteria& criteria);
  /// Forgets the blocks whose centre is farther than `radius` from `centre`.
  void keep_within(const Eigen::Vector3d& centre, double radius);
  void clear();

  /// The plane of the block, or null when there is none.
  [[nodiscard]] const Plane* find(const BlockIndex& at) const {
    const std::uint32_t block = slots_[slot_of(at)].block;
    return block == kNone || planes_[block].count == 0 ? nullptr : &planes_[block];
  }
  [[nodiscard]] const Moments* moments(const BlockIndex& at) const {
    const std::uint32_t block = slots_[slot_of(at)].block;
    return block == kNone ? nullptr : &moments_[block];
  }
  [[nodiscard]] Eigen::Vector3d centre(const BlockIndex& at) const {
    return edge_ * (Eigen::Vector3d(at.x, at.y, at.z).array() + half_);
  }

  [[nodiscard]] double edge() const { return edge_; }
  [[nodiscard]] std::size_t size() const { return index_.size(); }
  [[nodiscard]] std::size_t capacity() const { return limits_.blocks; }
  [[nodiscard]] std::size_t planes() const;

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t block = kNone;
  };

  [[nodiscard]] std::size_t slot_of(const BlockIndex& at) const;
  std::uint32_t find_or_make(const BlockIndex& at);
  void rehash();

  double edge_;
  double half_;  // centre of block 0 in blocks: ½, or 0 when staggered
  Limits limits_;
  std::vector<Slot> slots_;
  std::vector<BlockIndex> index_;  // dense, in order of creation, like the arrays below
  std::vector<Moments> moments_;
  std::vector<Plane> planes_;
  std::vector<float> fitted_;         // count at the last fit
  std::vector<std::uint32_t> grown_;  // blocks to be fitted
};

}  // namespace cairn
