// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "fusion/matching/features/cell_index.hpp"

namespace cairn::matching {

/// Exact nearest neighbours among points, by any cost that is at least the squared distance. The
/// book's methods pair in four and seven dimensions (3.9, 4.12, 4.13), with weights that change in
/// every iteration. In a map so dense that kMostLooks does not reach the gate, the answer is the
/// best of what was looked at.
class PointGrid {
 public:
  static constexpr int kNone = -1;
  /// Cells and points that a query looks at, at most, from the middle outwards. A bound on time: a
  /// crafted map of 1 kB held the fuzzer for 30 s.
  static constexpr int kMostLooks = 8192;
  /// Edge of a cell, at least, m. A map of tiny voxels must not give a gate millions of cells.
  static constexpr float kMinCell_m = 0.3F;

  /// Keeps a copy of the points (m).
  PointGrid(std::vector<Eigen::Vector3f> points, float cell_m)
      : points_(std::move(points)), cell_m_(std::max(cell_m, kMinCell_m)) {
    std::vector<std::uint64_t> keys(points_.size());
    std::transform(points_.begin(), points_.end(), keys.begin(),
                   [&](const Eigen::Vector3f& p) { return pack(cell_of(p)); });
    order_.resize(points_.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return key(keys, a) < key(keys, b); });
    for (std::size_t i = 0; i < order_.size(); ++i)
      if (i == 0 || key(keys, order_[i]) != key(keys, order_[i - 1])) {
        index_.find_or_insert(key(keys, order_[i]), static_cast<int>(starts_.size()));
        starts_.push_back(i);
      }
    starts_.push_back(order_.size());
    for (const Eigen::Vector3f& p : points_) blocks_.find_or_insert(pack(block_of(p)), 0);
  }

  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }

  /// The point of least `cost(index, squared distance)`, which must be ≥ the squared distance,
  /// within `gate_m` of `q`.
  template <class Cost>
  [[nodiscard]] int nearest(const Eigen::Vector3f& q, float gate_m, const Cost& cost) const {
    int best = kNone;
    float least = std::numeric_limits<float>::infinity();
    visit(q, gate_m, least, [&](int i, float squared) {
      const float c = cost(i, squared);
      if (c < least || (c == least && i < best)) {
        least = c;
        best = i;
      }
    });
    return best;
  }
  [[nodiscard]] int nearest(const Eigen::Vector3f& q, float gate_m) const {
    return nearest(q, gate_m, [](int, float squared) { return squared; });
  }

  /// A point near a query: its squared distance (m²) and its index.
  struct Neighbour {
    float squared;
    int index;
    friend bool operator<(const Neighbour& a, const Neighbour& b) {
      return a.squared < b.squared || (a.squared == b.squared && a.index < b.index);
    }
  };
  /// The `k` nearest within `gate_m`, nearest first.
  void nearest(const Eigen::Vector3f& q, float gate_m, std::size_t k, std::vector<Neighbour>& out) const {
    out.clear();
    float farthest = std::numeric_limits<float>::infinity();
    visit(q, gate_m, farthest, [&](int i, float squared) {
      const Neighbour n{squared, i};
      if (out.size() == k && !(n < out.back())) return;
      out.insert(std::upper_bound(out.begin(), out.end(), n), n);
      if (out.size() > k) out.pop_back();
      if (out.size() == k) farthest = out.back().squared;
    });
  }
  /// Number of points within `radius_m`, as far as kMostLooks reaches.
  [[nodiscard]] int count(const Eigen::Vector3f& q, float radius_m) const {
    int n = 0;
    const float all = std::numeric_limits<float>::infinity();
    visit(q, radius_m, all, [&](int, float) { ++n; });
    return n;
  }

 private:
  [[nodiscard]] static std::uint64_t key(const std::vector<std::uint64_t>& keys, int i) {
    return keys[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3f& p) const {
    return (p / cell_m_).array().floor().cast<int>();
  }

  [[nodiscard]] Eigen::Vector3i block_of(const Eigen::Vector3f& p) const {
    return (p / (kBlock_cells * cell_m_)).array().floor().cast<int>();
  }
  [[nodiscard]] bool far_from_all(const Eigen::Vector3f& q, float gate_m) const {
    const Eigen::Vector3f gate = Eigen::Vector3f::Constant(gate_m);
    const Eigen::Vector3i low = block_of(q - gate), high = block_of(q + gate);
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z)
          if (blocks_.find({x, y, z}) != CellIndex::kNone) return false;
    return true;
  }

  /// Calls use(index, squared distance) for points within the gate, in shells of cells around `q`.
  /// Ends when a shell is farther away than `bound` (squared), which `use` may lower.
  template <class Use>
  void visit(const Eigen::Vector3f& q, float gate_m, const float& bound, const Use& use) const {
    const Eigen::Vector3f scaled = q / cell_m_;
    if (!(scaled.cwiseAbs().maxCoeff() < kFarthest_cells) || scaled.hasNaN()) return;
    if (far_from_all(q, gate_m)) return;
    const Eigen::Vector3i home = cell_of(q);
    const Eigen::Vector3f in_cell = scaled - home.cast<float>();
    const float wall = std::min(in_cell.minCoeff(), 1 - in_cell.maxCoeff()) * cell_m_;
    const int shells = static_cast<int>(std::ceil(gate_m / cell_m_));
    int looks = kMostLooks;
    for (int r = 0; r <= shells && looks > 0; ++r) {
      const float away = r == 0 ? 0 : wall + static_cast<float>(r - 1) * cell_m_;
      if (away > gate_m || away * away > bound) return;
      for (int x = -r; x <= r; ++x)
        for (int y = -r; y <= r; ++y) {
          const bool edge = std::abs(x) == r || std::abs(y) == r;
          for (int z = -r; z <= r; z += edge || r == 0 ? 1 : 2 * r)
            use_cell(home + Eigen::Vector3i(x, y, z), q, gate_m * gate_m, use, looks);
        }
    }
  }
  template <class Use>
  void use_cell(const Eigen::Vector3i& cell, const Eigen::Vector3f& q, float squared_gate, const Use& use,
                int& looks) const {
    const int slot = --looks < 0 ? CellIndex::kNone : index_.find(cell);
    if (slot == CellIndex::kNone) return;
    const auto s = static_cast<std::size_t>(slot);
    for (std::size_t k = starts_[s]; k < starts_[s + 1] && --looks >= 0; ++k) {
      const float squared = (points_[static_cast<std::size_t>(order_[k])] - q).squaredNorm();
      if (squared < squared_gate) use(order_[k], squared);
    }
  }

  static constexpr float kBlock_cells = 5;        // edge of a block, for far_from_all()
  static constexpr float kFarthest_cells = 5e5F;  // well inside of what pack() can tell apart

  std::vector<Eigen::Vector3f> points_;
  float cell_m_;
  CellIndex index_, blocks_;
  std::vector<int> order_;
  std::vector<std::size_t> starts_;  // of each cell's points in order_, and the end
};

}  // namespace cairn::matching
