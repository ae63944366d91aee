// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/plane_grid.hpp"

#include <algorithm>
#include <bit>

#include "onboard/odometry/voxel_key.hpp"

namespace cairn {
namespace {

// A fit costs as much as forty additions, and a plane of 40 points does not change by one more.
constexpr float kRefitGrowth = 1.25F;

}  // namespace

PlaneGrid::PlaneGrid(float edge, bool staggered, const Limits& limits)
    : edge_(edge), half_(staggered ? 0.0 : 0.5), limits_(limits), slots_(std::bit_ceil(2 * limits.blocks)) {
  index_.reserve(limits.blocks);
  moments_.reserve(limits.blocks);
  planes_.reserve(limits.blocks);
  fitted_.reserve(limits.blocks);
  grown_.reserve(limits.blocks);
}

std::size_t PlaneGrid::slot_of(const BlockIndex& at) const {
  const std::uint64_t key = voxel_key(at.x, at.y, at.z);
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = voxel_hash(key) & mask;
  while (slots_[slot].block != kNone && slots_[slot].key != key) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t PlaneGrid::find_or_make(const BlockIndex& at) {
  Slot& slot = slots_[slot_of(at)];
  if (slot.block != kNone || index_.size() == limits_.blocks) return slot.block;
  slot = {voxel_key(at.x, at.y, at.z), static_cast<std::uint32_t>(index_.size())};
  index_.push_back(at);
  moments_.emplace_back();
  planes_.emplace_back();
  fitted_.push_back(0);
  return slot.block;
}

void PlaneGrid::add(const BlockIndex& at, const Eigen::Vector3d& p, float epoch) {
  const std::uint32_t block = find_or_make(at);
  if (block == kNone) return;
  Moments& m = moments_[block];
  if (m.count >= limits_.points) return;
  m.add((p - centre(at)).cast<float>(), epoch);
  // Marked once: the mark is the sign, which refit() clears.
  if (fitted_[block] >= 0 && m.count >= kRefitGrowth * fitted_[block]) {
    fitted_[block] = -m.count;
    grown_.push_back(block);
  }
}

void PlaneGrid::refit(const PlaneCriteria& criteria) {
  for (const std::uint32_t block : grown_) {
    planes_[block] = fit_plane(moments_[block], static_cast<float>(edge_), criteria);
    fitted_[block] = moments_[block].count;
  }
  grown_.clear();
}

void PlaneGrid::keep_within(const Eigen::Vector3d& centre_kept, double radius) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < index_.size(); ++i) {
    if ((centre(index_[i]) - centre_kept).squaredNorm() > radius * radius) continue;
    index_[kept] = index_[i];
    moments_[kept] = moments_[i];
    planes_[kept] = planes_[i];
    fitted_[kept] = fitted_[i];
    ++kept;
  }
  if (kept == index_.size()) return;
  index_.resize(kept);
  moments_.resize(kept);
  planes_.resize(kept);
  fitted_.resize(kept);
  rehash();
}

void PlaneGrid::rehash() {
  std::fill(slots_.begin(), slots_.end(), Slot{});
  for (std::size_t i = 0; i < index_.size(); ++i) {
    const BlockIndex& at = index_[i];
    slots_[slot_of(at)] = {voxel_key(at.x, at.y, at.z), static_cast<std::uint32_t>(i)};
  }
}

void PlaneGrid::clear() {
  index_.clear();
  moments_.clear();
  planes_.clear();
  fitted_.clear();
  grown_.clear();
  rehash();
}

std::size_t PlaneGrid::planes() const {
  return static_cast<std::size_t>(
      std::count_if(planes_.begin(), planes_.end(), [](const Plane& p) { return p.count > 0; }));
}

}  // namespace cairn
