// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/nearest_grid.hpp"

#include <algorithm>
#include <tuple>

namespace cairn::matching {
namespace {

// Coordinate of a cell, half of what pack() can tell apart.
constexpr float kMaxCell = 1 << 19;
constexpr std::size_t kSurfelsPerBrick = 8;  // a guess for the index's first size
constexpr std::size_t kLeastBricks = 16;     // the same, of small maps

Eigen::Vector3i brick_of(const Eigen::Vector3i& cell, int bits) {
  return {cell.x() >> bits, cell.y() >> bits, cell.z() >> bits};
}

}  // namespace

/// Fills a grid: each surfel is offered to all cells in its reach, some rows of a brick at once, so that
/// the compiler can vectorise.
class NearestGrid::Filling {
 public:
  Filling(NearestGrid& grid, float cell_m, float reach_m)
      : grid_(grid), cell_m_(cell_m), reach_m_(reach_m), squared_reach_(reach_m * reach_m) {}

  void offer(int surfel, const Eigen::Vector3f& point) {
    const auto brick_beside = [&](float offset_m) {
      return brick_of(((point.array() + offset_m) * grid_.inverse_cell_).floor().cast<int>(), kBits);
    };
    const Eigen::Vector3i first = brick_beside(-reach_m_), last = brick_beside(reach_m_);
    for (int z = first.z(); z <= last.z(); ++z)
      for (int y = first.y(); y <= last.y(); ++y)
        for (int x = first.x(); x <= last.x(); ++x) offer(surfel, point, {x, y, z});
  }

 private:
  using Row = std::array<float, kEdge>;
  using Layer = std::array<float, kEdge * kEdge>;
  // Of what the cells of a chunk hold, m²; the squared reach where they hold nothing.
  using Distances = std::array<std::array<float, std::tuple_size_v<Brick>>, kChunk>;

  /// Squared distances of a coordinate from the centres of a brick's cells, along one axis.
  [[nodiscard]] Row squares(float at, int brick) const {
    Row all{};
    for (int k = 0; k < 1 << kBits; ++k) {
      const float off = at - (static_cast<float>((brick << kBits) + k) + 0.5F) * cell_m_;
      all[static_cast<std::size_t>(k)] = off * off;
    }
    return all;
  }

  void offer(int surfel, const Eigen::Vector3f& point, const Eigen::Vector3i& place) {
    const Row x2 = squares(point.x(), place.x()), y2 = squares(point.y(), place.y()),
              z2 = squares(point.z(), place.z());
    Layer of_layer;
    for (std::size_t i = 0; i < of_layer.size(); ++i) of_layer[i] = x2[i % kEdge] + y2[i / kEdge];
    const float least_x2 = *std::min_element(x2.begin(), x2.end());
    int brick = kNone;
    for (std::size_t z = 0; z < kEdge; ++z) {
      const auto reached = [&](float in_y) { return least_x2 + in_y + z2[z] < squared_reach_; };
      const auto first = std::find_if(y2.begin(), y2.end(), reached), last = std::find_if_not(first, y2.end(), reached);
      if (first == last) continue;
      if (brick == kNone) brick = brick_at(place);
      if (brick == kNone) return;
      const auto i = static_cast<std::size_t>(brick), from = kEdge * static_cast<std::size_t>(first - y2.begin());
      const std::size_t at = kEdge * kEdge * z + from;
      keep(surfel, &of_layer[from], z2[z], kEdge * static_cast<std::size_t>(last - first),
           &(*distances_[i / kChunk])[i % kChunk][at], &grid_.brick(i)[at]);
    }
  }

  /// Written so that the compiler vectorises it.
  static void keep(int surfel, const float* xy2, float z2, std::size_t cells, float* nearest_m2, int* held) {
    for (std::size_t k = 0; k < cells; ++k) {
      const float squared_m = xy2[k] + z2;
      const int nearer = -static_cast<int>(squared_m < nearest_m2[k]);  // all bits or none
      held[k] ^= (held[k] ^ surfel) & nearer;
      nearest_m2[k] = std::min(squared_m, nearest_m2[k]);
    }
  }

  /// The number of a brick, which is made if need be; kNone beyond kMostBricks.
  int brick_at(const Eigen::Vector3i& place) {
    if (count_ == kMostBricks) return grid_.index_.find(place);
    const int i = grid_.index_.find_or_insert(pack(place), static_cast<int>(count_));
    if (static_cast<std::size_t>(i) < count_) return i;
    if (count_ % kChunk == 0) {
      grid_.chunks_.push_back(std::make_unique_for_overwrite<Chunk>());
      distances_.push_back(std::make_unique_for_overwrite<Distances>());
    }
    grid_.brick(count_).fill(kNone);
    (*distances_.back())[count_ % kChunk].fill(squared_reach_);
    ++count_;
    return i;
  }

  NearestGrid& grid_;
  float cell_m_, reach_m_, squared_reach_;
  std::vector<std::unique_ptr<Distances>> distances_;
  std::size_t count_ = 0;  // of bricks
};

NearestGrid::NearestGrid(std::span<const Surfel> surfels, float cell_m, float reach_m)
    : surfels_(surfels), inverse_cell_(1.0F / cell_m), index_(surfels.size() / kSurfelsPerBrick + kLeastBricks) {
  Filling filling(*this, cell_m, reach_m);
  for (std::size_t i = 0; i < surfels.size(); ++i) filling.offer(static_cast<int>(i), surfels[i].point);
}

std::size_t NearestGrid::slot(const Eigen::Vector3i& cell) {
  constexpr int kMask = (1 << kBits) - 1;
  return static_cast<std::size_t>(((cell.z() & kMask) << kBits | (cell.y() & kMask)) << kBits | (cell.x() & kMask));
}

int NearestGrid::nearest(const Eigen::Vector3f& point, float gate_m) const {
  const Eigen::Vector3f scaled = point * inverse_cell_;
  if (!(scaled.cwiseAbs().maxCoeff() < kMaxCell) || scaled.hasNaN()) return kNone;
  const Eigen::Vector3i cell = scaled.array().floor().cast<int>();
  const int at = index_.find(brick_of(cell, kBits));
  if (at == CellIndex::kNone) return kNone;
  const int i = brick(static_cast<std::size_t>(at))[slot(cell)];
  if (i == kNone || (surfels_[static_cast<std::size_t>(i)].point - point).squaredNorm() >= gate_m * gate_m)
    return kNone;
  return i;
}

}  // namespace cairn::matching
