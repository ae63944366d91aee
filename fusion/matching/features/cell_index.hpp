// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cairn::matching {

/// Integer coordinates of a cubic cell as one number, 21 bits each. Sorts by x, then y, then z.
[[nodiscard]] inline std::uint64_t pack(const Eigen::Vector3i& cell) {
  constexpr unsigned kBits = 21;  // of a coordinate: three fit into 64
  constexpr int kMiddle = 1 << (kBits - 1);
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
  const auto part = [&](int v) { return static_cast<std::uint64_t>(v + kMiddle) & kMask; };
  return part(cell.x()) << 2 * kBits | part(cell.y()) << kBits | part(cell.z());
}

/// A map from cells to numbers ≥ 0: an open-addressing table. It is never iterated, so no result
/// depends on its order.
class CellIndex {
 public:
  static constexpr int kNone = -1;

  explicit CellIndex(std::size_t expected = 16) { grow(expected); }

  [[nodiscard]] int find(std::uint64_t key) const {
    for (std::size_t i = hash(key);; i = (i + 1) & mask_)
      if (keys_[i] == key || values_[i] == kNone) return values_[i];
  }
  [[nodiscard]] int find(const Eigen::Vector3i& cell) const { return find(pack(cell)); }

  /// The number of this cell. If it has none, it gets `value`, which must be ≥ 0.
  int find_or_insert(std::uint64_t key, int value) {
    if (2 * (size_ + 1) > keys_.size()) grow(2 * size_ + 2);
    std::size_t i = hash(key);
    for (; values_[i] != kNone; i = (i + 1) & mask_)
      if (keys_[i] == key) return values_[i];
    keys_[i] = key;
    values_[i] = value;
    ++size_;
    return value;
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  [[nodiscard]] std::size_t hash(std::uint64_t key) const {
    // 2⁶⁴ over the golden ratio (Knuth, TAOCP 3, 6.4).
    constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;
    // Brings high bits to where the mask looks.
    constexpr unsigned kFold = 29;
    key *= kGolden;
    return static_cast<std::size_t>(key ^ key >> kFold) & mask_;
  }
  void grow(std::size_t expected) {
    constexpr std::size_t kLeastCapacity = 32;
    std::size_t capacity = kLeastCapacity;
    while (capacity < 2 * expected) capacity *= 2;
    const std::vector<std::uint64_t> keys = std::move(keys_);
    const std::vector<int> values = std::move(values_);
    keys_.assign(capacity, 0);
    values_.assign(capacity, kNone);
    mask_ = capacity - 1;
    size_ = 0;
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (values[i] != kNone) find_or_insert(keys[i], values[i]);
  }

  std::vector<std::uint64_t> keys_;
  std::vector<int> values_;
  std::size_t mask_ = 0, size_ = 0;
};

}  // namespace cairn::matching
