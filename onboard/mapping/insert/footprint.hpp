// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "onboard/mapping/insert/brick_grid.hpp"

namespace cairn::mapping {

/// One bit per voxel of a brick, in the order of BrickGrid: word = 4³ voxels, byte = 2³ voxels.
using BrickBits = std::array<std::uint64_t, 64>;

/// A brick that a scan touched.
struct BrickRef {
  std::uint64_t path;  ///< see BrickGrid::path_of_brick()
  std::uint32_t slot;  ///< for Footprint::free() and occupied()
  friend bool operator<(const BrickRef& a, const BrickRef& b) { return a.path < b.path; }
};

/// The set of voxels that one scan touches: those seen through and those hit, as bits in bricks.
/// Keeps its memory from scan to scan. Only touched bricks take memory, and no more of them than
/// the limit.
class Footprint {
 public:
  /// `max_bricks` bounds the memory (1 KiB each); what goes beyond is dropped and reported by
  /// overflown().
  explicit Footprint(std::size_t max_bricks) : max_bricks_(max_bricks) {}

  /// Empties the set and prepares for voxels in `grid`.
  void reset(const BrickGrid& grid);
  [[nodiscard]] const BrickGrid& grid() const { return grid_; }
  /// Whether bricks are found by a table over the whole grid; otherwise, when the box is huge, by
  /// hashing.
  [[nodiscard]] bool flat() const { return flat_; }

  /// `kFlat` must equal flat(): the ray march knows it before its inner loop.
  template <bool kFlat>
  void mark_free(std::uint64_t index) {
    const std::size_t word = words_of<kFlat>(index >> BrickGrid::kBrickShift) + ((index >> 6) & 63);
    free_.data()[word] |= std::uint64_t{1} << (index & 63);  // data(): unchecked, this is the innermost loop
  }
  /// mark_free<true>(index) for an index that comes in parts: index >> 12, index >> 6 & 63, and
  /// itself.
  void mark_free_flat(std::uint64_t brick, std::uint64_t word, std::uint64_t index) {
    const std::size_t at = words_of<true>(brick) + word;  // first: it may move the words
    free_.data()[at] |= std::uint64_t{1} << (index & 63);
  }
  /// Returns false if the voxel was marked before.
  bool mark_occupied(std::uint64_t index);

  /// Adds all voxels of another footprint over the same grid.
  void merge(const Footprint& other);

  /// Touched bricks in the depth-first order of the tree; valid until the footprint changes.
  [[nodiscard]] std::span<const BrickRef> sorted_bricks();
  [[nodiscard]] const std::uint64_t* free(std::uint32_t slot) const { return &free_[slot * kWords]; }
  [[nodiscard]] const std::uint64_t* occupied(std::uint32_t slot) const { return &occupied_[slot * kWords]; }
  [[nodiscard]] std::size_t brick_count() const { return bricks_.size() - 1; }
  /// The limit was reached: the set is incomplete.
  [[nodiscard]] bool overflown() const { return overflown_; }
  [[nodiscard]] std::size_t bytes() const;

  static constexpr std::size_t kWords = 64;  ///< of 64 bits each: one bit per voxel of a brick

 private:
  static constexpr unsigned kMaxFlatBits = 22;  // of a brick's index: a table of 16 MiB; larger boxes are hashed

  /// Where the words of a brick start: slot × 64. 0 stands for an untouched brick in the table, and
  /// as a result for words that take what must be dropped.
  template <bool kFlat>
  std::size_t words_of(std::uint64_t brick) {
    const std::uint32_t words = kFlat ? table_.data()[brick] : find(brick);
    return words != 0 ? words : add_brick(brick);
  }
  [[nodiscard]] std::uint32_t find(std::uint64_t brick) const { return table_[hash_place(brick)]; }
  [[gnu::noinline]] std::uint32_t add_brick(std::uint64_t brick);
  void make_room(std::size_t slots);
  void enter(std::uint64_t brick, std::uint32_t words);
  [[nodiscard]] std::size_t hash_place(std::uint64_t brick) const;
  void rehash(std::size_t places);

  std::size_t max_bricks_;
  BrickGrid grid_;
  bool flat_ = true, overflown_ = false;
  std::vector<std::uint32_t> table_;  // flat: brick → words_of(); else: open addressing, place → the same
  std::vector<std::uint64_t> free_{std::vector<std::uint64_t>(kWords)}, occupied_{std::vector<std::uint64_t>(kWords)};
  std::vector<std::uint64_t> bricks_{0};  // slot → brick; slot 0 is not used
  std::vector<BrickRef> refs_;
};

}  // namespace cairn::mapping
