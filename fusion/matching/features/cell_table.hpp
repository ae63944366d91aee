// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fusion/matching/features/cell_index.hpp"

namespace cairn::matching {

/// A map from cells to numbers ≥ 0, for cells that lie close together, as those of surfaces do. It
/// keeps them in blocks of 4³. No result depends on the order of its cells.
class CellTable {
 public:
  static constexpr int kNone = CellIndex::kNone;

  [[nodiscard]] int find(const Eigen::Vector3i& cell) const {
    const int block = blocks_.find(block_of(cell));
    return block == kNone ? kNone : numbers_[static_cast<std::size_t>(block)][slot(cell)];
  }

  /// The number of this cell. If it has none, it gets `value`, which must be ≥ 0.
  int find_or_insert(const Eigen::Vector3i& cell, int value) {
    const int block = blocks_.find_or_insert(pack(block_of(cell)), static_cast<int>(numbers_.size()));
    if (static_cast<std::size_t>(block) == numbers_.size()) numbers_.emplace_back().fill(kNone);
    int& number = numbers_[static_cast<std::size_t>(block)][slot(cell)];
    if (number == kNone) number = value;
    return number;
  }

  /// Finds cells that lie next to each other faster: it remembers the last blocks. Void once the
  /// table changes.
  class Neighbours {
   public:
    /// `table` must outlive this.
    explicit Neighbours(const CellTable& table) : table_(&table) { keys_.fill(kNoKey); }

    [[nodiscard]] int find(const Eigen::Vector3i& cell) {
      const Eigen::Vector3i block = block_of(cell);
      // The eight blocks that a cell and its neighbours can lie in have different parities.
      const auto i = static_cast<std::size_t>((block.x() & 1) | (block.y() & 1) << 1 | (block.z() & 1) << 2);
      const std::uint64_t key = pack(block);
      if (keys_[i] != key) {
        keys_[i] = key;
        blocks_[i] = table_->blocks_.find(key);
      }
      return blocks_[i] == kNone ? kNone : table_->numbers_[static_cast<std::size_t>(blocks_[i])][slot(cell)];
    }

   private:
    static constexpr std::uint64_t kNoKey = ~std::uint64_t{0};  // pack() has 63 bits
    static constexpr std::size_t kParities = 8;

    const CellTable* table_;
    std::array<std::uint64_t, kParities> keys_{};
    std::array<int, kParities> blocks_{};
  };

 private:
  static constexpr int kBits = 2, kMask = (1 << kBits) - 1;  // of a coordinate in a block
  using Block = std::array<int, std::size_t{1} << 3 * kBits>;

  [[nodiscard]] static Eigen::Vector3i block_of(const Eigen::Vector3i& cell) {
    return {cell.x() >> kBits, cell.y() >> kBits, cell.z() >> kBits};
  }
  [[nodiscard]] static std::size_t slot(const Eigen::Vector3i& cell) {
    return static_cast<std::size_t>(((cell.z() & kMask) << kBits | (cell.y() & kMask)) << kBits | (cell.x() & kMask));
  }

  CellIndex blocks_;
  std::vector<Block> numbers_;
};

}  // namespace cairn::matching
