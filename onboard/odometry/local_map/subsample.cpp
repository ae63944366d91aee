// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/local_map/subsample.hpp"

#include <bit>

#include "onboard/odometry/local_map/voxel_key.hpp"

namespace cairn::odometry {
namespace {

/// The same for the same index, and as if at random (the finaliser of MurmurHash3). voxel_hash() of neighbours is too
/// regular: of six points in a row one would be drawn in 24 % of the cubes, another in 9 %.
std::uint32_t draw(std::uint32_t index) {
  index = (index ^ index >> 16U) * 0x85EBCA6BU;
  index = (index ^ index >> 13U) * 0xC2B2AE35U;
  return index ^ index >> 16U;
}

}  // namespace

void Subsample::reserve(std::size_t n) {
  if (slots_.size() < 2 * n) {
    slots_.assign(std::bit_ceil(2 * n), {});
    call_ = 0;
  }
  if (++call_ == 0) {  // the counter wrapped: old marks would look new
    std::fill(slots_.begin(), slots_.end(), Slot{});
    call_ = 1;
  }
  kept_.clear();
  kept_.reserve(n);
}

std::span<const std::uint32_t> Subsample::operator()(std::span<const Eigen::Vector3f> points,
                                                     std::span<const std::uint32_t> candidates, float edge) {
  reserve(candidates.size());
  const float scale = 1.0F / edge;
  const std::size_t mask = slots_.size() - 1;
  for (const std::uint32_t i : candidates) {
    const Eigen::Vector3f p = points[i] * scale;
    const std::uint64_t key = voxel_key(floor_to_int(p.x()), floor_to_int(p.y()), floor_to_int(p.z()));
    std::size_t at = voxel_hash(key) & mask;
    while (slots_[at].call == call_ && slots_[at].key != key) at = (at + 1) & mask;
    if (slots_[at].call == call_) {
      std::uint32_t& kept = kept_[slots_[at].position];
      if (draw(i) < draw(kept)) kept = i;
      continue;
    }
    slots_[at] = {key, call_, static_cast<std::uint32_t>(kept_.size())};
    kept_.push_back(i);
  }
  return kept_;
}

}  // namespace cairn::odometry
