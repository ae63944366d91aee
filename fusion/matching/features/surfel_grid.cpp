// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/features/surfel_grid.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cairn::matching {
namespace {

constexpr int kTile_voxels = 1 << mapping::TileKey::kVoxelBits;  // edge of a tile
// Added to the spread's diagonal, in squared cells: keeps the eigenvalues of exact planes apart
// from zero. Chosen by hand, not tuned.
constexpr float kLeastSpread_cells2 = 1e-6F;
// Of a voxel: keeps the sums of a cell apart from zero, and bounds them where a map has no doubt.
constexpr float kLeastEvidence = 0.02F, kLeastDoubt = 0.001F;
constexpr float kUniformVariance = 12;  // a uniform distribution of width d has variance d²/12

/// The log-odds that a voxel is occupied.
float evidence_of(const Voxel& v) {
  return std::max(kLeastEvidence, std::log(v.occupancy / std::max(kLeastDoubt, 1 - v.occupancy)));
}

int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

template <class Visit>
void for_27(const Visit& visit) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) visit(Eigen::Vector3i(x, y, z));
}

}  // namespace

SurfelGrid::SurfelGrid(int voxels_per_cell, float resolution_m, int min_voxels)
    : voxels_per_cell_(voxels_per_cell),
      min_voxels_(min_voxels),
      resolution_m_(resolution_m),
      cell_m_(static_cast<float>(voxels_per_cell) * resolution_m) {}

SurfelGrid::Cell& SurfelGrid::cell_at(const Eigen::Vector3i& cell) {
  const auto next = static_cast<int>(cells_.size());
  const int i = index_.find_or_insert(cell, next);
  if (i == next) {
    cells_.emplace_back();
    cells_.back().cell = cell;
  }
  return cells_[static_cast<std::size_t>(i)];
}

void SurfelGrid::make_stale(int i) {
  Cell& cell = cells_[static_cast<std::size_t>(i)];
  if (!cell.stale) stale_.push_back(i);
  cell.stale = true;
}

void SurfelGrid::clear_tile(mapping::TileKey tile) {
  Eigen::Vector3i first;
  for (unsigned axis = 0; axis < 3; ++axis)
    first[axis] = floor_div(static_cast<int>(tile.first_voxel(axis)) - kKeyOrigin, voxels_per_cell_);
  const int edge = kTile_voxels / voxels_per_cell_;
  for (int x = 0; x < edge; ++x)
    for (int y = 0; y < edge; ++y)
      for (int z = 0; z < edge; ++z) {
        const int i = index_.find(first + Eigen::Vector3i(x, y, z));
        if (i == CellTable::kNone) continue;
        cells_[static_cast<std::size_t>(i)].clear();
        make_stale(i);
      }
}

void SurfelGrid::replace_tile(mapping::TileKey tile, std::span<const Voxel> voxels) {
  clear_tile(tile);
  add_tile(voxels);
}

void SurfelGrid::add_tile(std::span<const Voxel> voxels) {
  for (const Voxel& v : voxels) {
    const Eigen::Vector3i key(floor_div(v.key.x(), voxels_per_cell_), floor_div(v.key.y(), voxels_per_cell_),
                              floor_div(v.key.z(), voxels_per_cell_));
    Cell& cell = cell_at(key);
    const Eigen::Vector3i in_cell = v.key - voxels_per_cell_ * key;
    const Eigen::Vector3f d =
        ((in_cell.cast<float>().array() + 0.5F) - 0.5F * static_cast<float>(voxels_per_cell_)) * resolution_m_;
    const float weight = evidence_of(v);
    cell.sum += weight * d;
    cell.squares.noalias() += weight * d * d.transpose();
    cell.evidence += weight;
    cell.occupancy += v.occupancy;
    ++cell.count;
    make_stale(static_cast<int>(&cell - cells_.data()));
  }
}

void SurfelGrid::refresh() {
  // The neighbours' fits use them too.
  const std::size_t changed = stale_.size() == cells_.size() ? 0 : stale_.size();
  CellTable::Neighbours near(index_);
  for (std::size_t k = 0; k < changed; ++k) {
    const Eigen::Vector3i cell = cells_[static_cast<std::size_t>(stale_[k])].cell;
    for_27([&](const Eigen::Vector3i& step) {
      const int i = near.find(cell + step);
      if (i != CellTable::kNone) make_stale(i);
    });
  }
  for (const int i : stale_) {
    Cell& cell = cells_[static_cast<std::size_t>(i)];
    if (cell.count > 0) cell.surfel = fit(cell, near);
    cell.stale = false;
  }
  stale_.clear();
  put_in_order();
}

Surfel SurfelGrid::fit(const Cell& cell, CellTable::Neighbours& near) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  float evidence = 0;
  int count = 0;
  for_27([&](const Eigen::Vector3i& step) {
    const int i = near.find(cell.cell + step);
    if (i == CellTable::kNone) return;
    const Cell& other = cells_[static_cast<std::size_t>(i)];
    const float n = other.evidence;
    const Eigen::Vector3f t = step.cast<float>() * cell_m_;
    sum += other.sum + n * t;
    squares.noalias() += other.squares + other.sum * t.transpose() + t * other.sum.transpose() + n * t * t.transpose();
    evidence += n;
    count += other.count;
  });
  const auto own = static_cast<float>(cell.count);
  Surfel s{.point = centre(cell) + cell.sum / cell.evidence,
           .variation = 1.0F / 3.0F,
           .occupancy = cell.occupancy / own,
           .evidence = cell.evidence};
  if (count < min_voxels_) return s;
  const Eigen::Vector3f mean = sum / evidence;
  const Eigen::Matrix3f spread = squares / evidence - mean * mean.transpose() +
                                 kLeastSpread_cells2 * cell_m_ * cell_m_ * Eigen::Matrix3f::Identity();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(spread);
  s.normal = solver.eigenvectors().col(0);
  s.variation = std::max(solver.eigenvalues()[0], 0.0F) / solver.eigenvalues().sum();
  // Within a layer of voxels.
  const float of_one_face = resolution_m_ * resolution_m_ / kUniformVariance;
  s.half_thickness = std::sqrt(std::max(solver.eigenvalues()[0] - of_one_face, 0.0F));
  // The staircase of voxels along a slanted wall is an artefact of the grid.
  if (s.flat()) s.point -= s.normal * s.normal.dot(s.point - (centre(cell) + mean));
  return s;
}

void SurfelGrid::put_in_order() {
  const auto known = static_cast<std::ptrdiff_t>(order_.size());
  for (std::size_t i = order_.size(); i < cells_.size(); ++i)
    order_.emplace_back(pack(cells_[i].cell), static_cast<int>(i));
  std::sort(order_.begin() + known, order_.end());
  std::inplace_merge(order_.begin(), order_.begin() + known, order_.end());
}

std::vector<Surfel> SurfelGrid::surfels() const {
  std::vector<Surfel> all;
  all.reserve(order_.size());
  for (const auto& [key, i] : order_)
    if (const Cell& cell = cells_[static_cast<std::size_t>(i)]; cell.count > 0) all.push_back(cell.surfel);
  return all;
}

}  // namespace cairn::matching
