// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace cairn::mapping {

/// Voxel keys along x, y, z: 0…65535 inside the tree.
using VoxelKey = std::array<int, 3>;

/// Numbers the voxels of a box such that a step to a neighbour is one subtraction and one mask. A brick is a cube of
/// 16³ voxels, that is a node at depth 12 of the tree. The index of a voxel is, from the highest bit,
///
///     z brick | y brick | x brick | 12 bits: the lowest four bits of z, y and x interleaved, x lowest
///
/// The twelve low bits spell OctoMap's child indices at depths 12 to 15, so the 64 voxels that share index >> 6 are a
/// cube of 4³ (a node at depth 14), and the 8 that share index >> 3 are a node at depth 15.
class BrickGrid {
 public:
  static constexpr unsigned kBrickShift = 12;  ///< index >> kBrickShift is the brick
  static constexpr int kEdge = 16;

  BrickGrid() = default;
  /// Covers the keys lo to hi, both inclusive, rounded outwards to bricks.
  BrickGrid(const VoxelKey& lo, const VoxelKey& hi) {
    unsigned shift = kBrickShift;
    for (unsigned a = 0; a < 3; ++a) {
      base_[a] = lo[a] & ~(kEdge - 1);
      bits_[a] = static_cast<unsigned>(std::bit_width(static_cast<unsigned>(hi[a] - base_[a]) / kEdge));
      shift_[a] = shift;
      mask_[a] = (std::uint64_t{0x249} << a) | (((std::uint64_t{1} << bits_[a]) - 1) << shift);
      shift += bits_[a];
    }
    brick_bits_ = shift - kBrickShift;
  }

  [[nodiscard]] std::uint64_t index(const VoxelKey& key) const {
    return axis_index(0, key[0]) | axis_index(1, key[1]) | axis_index(2, key[2]);
  }
  /// The bits of an index that belong to one axis.
  [[nodiscard]] std::uint64_t axis_mask(unsigned axis) const { return mask_[axis]; }
  /// Subtract this from an axis' bits, then mask, to step by `sign` (−1, 0, 1).
  [[nodiscard]] std::uint64_t axis_step(unsigned axis, int sign) const {
    return sign > 0 ? mask_[axis] : sign < 0 ? std::uint64_t{1} << axis : 0;
  }
  /// Bricks are numbered below 2^brick_bits().
  [[nodiscard]] unsigned brick_bits() const { return brick_bits_; }

  /// The path from the root to the brick's node: twelve octal digits, the child index at depth 0 highest.
  [[nodiscard]] std::uint64_t path_of_brick(std::uint64_t brick) const {
    std::uint64_t path = 0;
    for (unsigned a = 0; a < 3; ++a) {
      const auto local = static_cast<unsigned>(brick & ((std::uint64_t{1} << bits_[a]) - 1));
      brick >>= bits_[a];
      path |= spread((static_cast<unsigned>(base_[a]) / kEdge + local) & 0xFFFU) << a;
    }
    return path;
  }

 private:
  [[nodiscard]] std::uint64_t axis_index(unsigned axis, int key) const {
    const auto local = static_cast<std::uint64_t>(key - base_[axis]);
    const std::uint64_t low = (local & 1) | (local & 2) << 2 | (local & 4) << 4 | (local & 8) << 6;
    return low << axis | (local >> 4) << shift_[axis];
  }
  /// Bit i of the lowest twelve goes to bit 3 i.
  static constexpr std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 16) & 0x0000ff0000ff;
    x = (x | x << 8) & 0x00f00f00f00f;
    x = (x | x << 4) & 0x0c30c30c30c3;
    return (x | x << 2) & 0x249249249249;
  }

  VoxelKey base_{};
  std::array<unsigned, 3> bits_{}, shift_{};
  std::array<std::uint64_t, 3> mask_{};
  unsigned brick_bits_ = 0;
};

}  // namespace cairn::mapping
