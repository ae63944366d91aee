// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/nearest_grid.hpp"

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

NearestGrid::NearestGrid(std::span<const Surfel> surfels, float cell_m, float reach_m)
    : surfels_(surfels),
      cell_m_(cell_m),
      inverse_cell_(1.0F / cell_m),
      index_(surfels.size() / kSurfelsPerBrick + kLeastBricks) {
  spread(reach_m);
}

std::size_t NearestGrid::slot(const Eigen::Vector3i& cell) {
  constexpr int kMask = kEdge - 1;
  return static_cast<std::size_t>(((cell.z() & kMask) << kBits | (cell.y() & kMask)) << kBits | (cell.x() & kMask));
}

int* NearestGrid::entry(const Eigen::Vector3i& cell) {
  const std::uint64_t brick = pack(brick_of(cell, kBits));
  int i = index_.find(brick);
  if (i == CellIndex::kNone) {
    if (bricks_.size() == kMostBricks) return nullptr;
    i = index_.find_or_insert(brick, static_cast<int>(bricks_.size()));
    bricks_.emplace_back().fill(kNone);
  }
  return &bricks_[static_cast<std::size_t>(i)][slot(cell)];
}

float NearestGrid::squared_distance(const Eigen::Vector3i& cell, int surfel) const {
  const Eigen::Vector3f centre = (cell.cast<float>().array() + 0.5F) * cell_m_;
  return (surfels_[static_cast<std::size_t>(surfel)].point - centre).squaredNorm();
}

void NearestGrid::offer(const Eigen::Vector3i& cell, int surfel, float squared_reach,
                        std::vector<Eigen::Vector3i>& changed) {
  const float distance = squared_distance(cell, surfel);
  if (!(distance < squared_reach)) return;
  int* held = entry(cell);
  if (held == nullptr || (*held != kNone && squared_distance(cell, *held) <= distance)) return;
  *held = surfel;
  changed.push_back(cell);
}

void NearestGrid::spread(float reach_m) {
  std::vector<Eigen::Vector3i> front, next;
  for (std::size_t i = 0; i < surfels_.size(); ++i) {
    const Eigen::Vector3i cell = (surfels_[i].point * inverse_cell_).array().floor().cast<int>();
    offer(cell, static_cast<int>(i), reach_m * reach_m, front);
  }
  for (; !front.empty(); std::swap(front, next), next.clear())
    for (const Eigen::Vector3i& cell : front) {
      const int surfel = *entry(cell);
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          Eigen::Vector3i neighbour = cell;
          neighbour[axis] += step;
          offer(neighbour, surfel, reach_m * reach_m, next);
        }
    }
}

int NearestGrid::nearest(const Eigen::Vector3f& point, float gate_m) const {
  const Eigen::Vector3f scaled = point * inverse_cell_;
  if (!(scaled.cwiseAbs().maxCoeff() < kMaxCell) || scaled.hasNaN()) return kNone;
  const Eigen::Vector3i cell = scaled.array().floor().cast<int>();
  const int brick = index_.find(brick_of(cell, kBits));
  if (brick == CellIndex::kNone) return kNone;
  const int i = bricks_[static_cast<std::size_t>(brick)][slot(cell)];
  if (i == kNone || (surfels_[static_cast<std::size_t>(i)].point - point).squaredNorm() >= gate_m * gate_m)
    return kNone;
  return i;
}

}  // namespace cairn::matching
