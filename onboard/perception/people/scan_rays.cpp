// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/scan_rays.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::people {
namespace {

constexpr float kBehind = 0.5F;  // m
// A whole body, and the part of it that legs and arms leave no gaps in.
constexpr ScanRays::Slice kBodySlice{.half_width = 0.2F, .lowest = 0.2F, .highest = 1.7F};
constexpr ScanRays::Slice kTrunkSlice{.half_width = 0.15F, .lowest = 0.3F, .highest = 1.4F};
constexpr ScanRays::Slice kChestSlice{.half_width = 0.15F, .lowest = 0.8F, .highest = 1.5F};
constexpr int kFewestThrough = 4, kFewestBefore = 4, kFewestReaching = 10;
constexpr int kTimes = 3;  // as many as the others

}  // namespace

/// Equal steps of y / (|x| + |y|) in each quarter: as good as angles, and without a trigonometric function.
std::size_t ScanRays::column_of(const Eigen::Vector2f& direction) {
  const float share = direction.y() / (std::abs(direction.x()) + std::abs(direction.y()));   // -1 to 1
  const float turn = direction.x() < 0 ? 2 - share : direction.y() < 0 ? 4 + share : share;  // 0 to 4
  return std::min(static_cast<std::size_t>(turn * (kColumns / 4)), kColumns - 1);
}

void ScanRays::fill(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& sensor) {
  sensor_ = sensor;
  begin_.assign(kColumns + 1, 0);
  column_.assign(points.size(), kColumns);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2f to = points[i].head<2>() - sensor.head<2>();
    if (!points[i].allFinite() || to.isZero(0)) continue;
    column_[i] = static_cast<std::uint16_t>(column_of(to));
    ++begin_[column_[i] + 1U];
  }
  for (std::size_t c = 0; c < kColumns; ++c) begin_[c + 1] += begin_[c];
  rays_.resize(begin_.back());
  for (std::size_t i = points.size(); i-- > 0;)
    if (column_[i] < kColumns) rays_[--begin_[column_[i] + 1U]] = points[i] - sensor;
  std::rotate(begin_.begin(), begin_.begin() + 1, begin_.end());  // filling has moved each end to its column's begin
  begin_.back() = static_cast<std::uint32_t>(rays_.size());
}

ScanRays::Count ScanRays::count(const Eigen::Vector2d& place, float ground, const Slice& slice) const {
  Count count;
  const Eigen::Vector2f to = place.cast<float>() - sensor_.head<2>();
  const float distance = to.norm();
  if (!(distance > kBehind) || !std::isfinite(distance) || rays_.empty()) return count;
  const Eigen::Vector2f along = to / distance, left(-along.y(), along.x());
  const std::size_t last = column_of(to + slice.half_width * left);
  for (std::size_t c = column_of(to - slice.half_width * left);; c = (c + 1) % kColumns) {
    for (std::uint32_t i = begin_[c]; i < begin_[c + 1]; ++i) {
      const float forward = rays_[i].head<2>().dot(along);
      if (!(forward > 0)) continue;
      const float share = distance / forward;  // of the ray, up to the body's place
      const float height = sensor_.z() + share * rays_[i].z() - ground;
      if (std::abs(share * rays_[i].head<2>().dot(left)) > slice.half_width) continue;
      if (height < slice.lowest || height > slice.highest) continue;
      ++(forward > distance + kBehind ? count.through : forward < distance - kBehind ? count.before : count.within);
    }
    if (c == last) return count;
  }
}

bool ScanRays::seen_through(const Eigen::Vector2d& place, float ground) const {
  const Count rays = count(place, ground, kBodySlice);
  return rays.through >= kFewestThrough && rays.through >= kTimes * rays.within;
}

bool ScanRays::chest_is_hidden(const Eigen::Vector2d& place, float ground) const {
  const Count rays = count(place, ground, kChestSlice);
  return rays.before >= kFewestBefore && rays.before >= kTimes * (rays.through + rays.within);
}

float ScanRays::passed(const Eigen::Vector2d& place, float ground) const {
  const Count rays = count(place, ground, kTrunkSlice);
  const int reaching = rays.through + rays.within;
  return reaching < kFewestReaching ? 0 : static_cast<float>(rays.through) / static_cast<float>(reaching);
}

}  // namespace cairn::people
