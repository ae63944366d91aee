// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/patch_grid.hpp"

#include <algorithm>
#include <bit>

#include "onboard/odometry/local_map/voxel_key.hpp"

namespace cairn::odometry {
namespace {

// A block is fitted again when its points have grown by this factor. A fit costs as much as forty
// additions, and a plane of 40 points does not change by one more.
constexpr float kRefitGrowth = 1.25F;

}  // namespace

PatchGrid::PatchGrid(float edge, bool staggered, const Limits& limits)
    : edge_(edge), half_(staggered ? 0.0 : 0.5), limits_(limits), slots_(std::bit_ceil(2 * limits.blocks)) {
  index_.reserve(limits.blocks);
  side_.reserve(limits.blocks);
  moments_.reserve(limits.blocks);
  patches_.reserve(limits.blocks);
  first_s_.reserve(limits.blocks);
  fitted_.reserve(limits.blocks);
  grown_.reserve(limits.blocks);
}

std::uint64_t PatchGrid::key_of(const BlockIndex& at, Side side) {
  return voxel_key(at.x, at.y, at.z) | static_cast<std::uint64_t>(side) << 63;
}

std::size_t PatchGrid::slot_of(const BlockIndex& at, Side side) const {
  const std::uint64_t key = key_of(at, side);
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = voxel_hash(key) & mask;
  while (slots_[slot].block != kNone && slots_[slot].key != key) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t PatchGrid::find_or_make(const BlockIndex& at, Side side, float time_s) {
  Slot& slot = slots_[slot_of(at, side)];
  if (slot.block != kNone || index_.size() == limits_.blocks) return slot.block;
  slot = {key_of(at, side), static_cast<std::uint32_t>(index_.size())};
  index_.push_back(at);
  side_.push_back(side);
  moments_.emplace_back();
  patches_.emplace_back();
  first_s_.push_back(time_s);
  fitted_.push_back(0);
  return slot.block;
}

void PatchGrid::add(const BlockIndex& at, const Eigen::Vector3d& p, const Eigen::Vector3f& to_sensor,
                    const Seen& when) {
  std::uint32_t block = find_or_make(at, kFront, when.time_s);
  if (block != kNone && seen_from_behind(patches_[block], to_sensor)) block = find_or_make(at, kBack, when.time_s);
  if (block == kNone) return;
  patches_[block].lasting = when.time_s >= first_s_[block] + limits_.lasting_s;
  Moments& m = moments_[block];
  if (m.count >= limits_.points) return;
  m.add((p - centre(at)).cast<float>(), when.epoch);
  if (fitted_[block] >= 0 && m.count >= kRefitGrowth * fitted_[block]) {
    fitted_[block] = -m.count;
    grown_.push_back(block);
  }
}

void PatchGrid::refit(const PatchCriteria& criteria, const Sensor& sensor) {
  for (const std::uint32_t block : grown_) {
    const Viewpoint from{(sensor.position - centre(index_[block])).cast<float>(), sensor.up};
    const bool lasting = patches_[block].lasting;
    patches_[block] = fit_patch(moments_[block], static_cast<float>(edge_), criteria, from);
    patches_[block].lasting = lasting;
    fitted_[block] = moments_[block].count;
  }
  grown_.clear();
}

void PatchGrid::keep_within(const Eigen::Vector3d& centre_kept, double radius) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < index_.size(); ++i) {
    if ((centre(index_[i]) - centre_kept).squaredNorm() > radius * radius) continue;
    index_[kept] = index_[i];
    side_[kept] = side_[i];
    moments_[kept] = moments_[i];
    patches_[kept] = patches_[i];
    first_s_[kept] = first_s_[i];
    fitted_[kept] = fitted_[i];
    ++kept;
  }
  if (kept == index_.size()) return;
  index_.resize(kept);
  side_.resize(kept);
  moments_.resize(kept);
  patches_.resize(kept);
  first_s_.resize(kept);
  fitted_.resize(kept);
  rehash();
}

void PatchGrid::rehash() {
  std::fill(slots_.begin(), slots_.end(), Slot{});
  for (std::size_t i = 0; i < index_.size(); ++i)
    slots_[slot_of(index_[i], side_[i])] = {key_of(index_[i], side_[i]), static_cast<std::uint32_t>(i)};
}

void PatchGrid::clear() {
  index_.clear();
  side_.clear();
  moments_.clear();
  patches_.clear();
  first_s_.clear();
  fitted_.clear();
  grown_.clear();
  rehash();
}

std::size_t PatchGrid::patches() const {
  return static_cast<std::size_t>(
      std::count_if(patches_.begin(), patches_.end(), [](const Patch& p) { return p.kind != Patch::Kind::kNone; }));
}

}  // namespace cairn::odometry
