// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/labelling/located_scans.hpp"

#include <algorithm>

namespace cairn::labelling {

LocatedScans::LocatedScans(const Limits& limits) : limits_(limits), slots_(std::max<std::size_t>(limits.scans, 2)) {}

void LocatedScans::drop_oldest() {
  points_ -= (*this)[0].points_base.size();
  first_ = (first_ + 1) % slots_.size();
  --count_;
}

void LocatedScans::make_room(std::size_t points, Time newest) {
  while (count_ > 0 &&
         (count_ == slots_.size() || newest - (*this)[0].stamp > limits_.age || points_ + points > limits_.points))
    drop_oldest();
}

bool LocatedScans::add(Time stamp, const SE3& T_odom_base, const Vector6& twist, std::uint32_t epoch,
                       std::span<const Eigen::Vector3f> points_base) {
  if (count_ > 0 && epoch == newest().epoch && stamp <= newest().stamp) return false;
  if (count_ > 0 && epoch != newest().epoch) clear();
  make_room(points_base.size(), stamp);
  PlacedScan& slot = slots_[(first_ + count_) % slots_.size()];
  slot.stamp = stamp;
  slot.T_odom_base = T_odom_base;
  slot.twist = twist;
  slot.epoch = epoch;
  slot.points_base.assign(points_base.begin(), points_base.end());
  points_ += points_base.size();
  ++count_;
  return true;
}

std::size_t LocatedScans::first_after(Time t) const {
  std::size_t i = 0;
  while (i < count_ && (*this)[i].stamp <= t) ++i;
  return i;
}

std::optional<SE3> LocatedScans::pose_at(Time t, Beyond beyond) const {
  const std::size_t after = first_after(t);
  if (after == 0) return std::nullopt;
  const PlacedScan& a = (*this)[after - 1];
  if (a.stamp == t) return a.T_odom_base;
  if (after == count_) {
    if (beyond == Beyond::kNothing || t - a.stamp > kFarthest) return std::nullopt;
    return a.T_odom_base * SE3::exp(a.twist * to_seconds(t - a.stamp));
  }
  const PlacedScan& b = (*this)[after];
  if (b.stamp - a.stamp > limits_.longest_gap) return std::nullopt;
  const double share = to_seconds(t - a.stamp) / to_seconds(b.stamp - a.stamp);
  return a.T_odom_base * SE3::exp(share * (a.T_odom_base.inverse() * b.T_odom_base).log());
}

std::optional<Vector6> LocatedScans::twist_at(Time t, Beyond beyond) const {
  if (!pose_at(t, beyond)) return std::nullopt;
  const std::size_t after = first_after(t);
  const PlacedScan& a = (*this)[after - 1];
  if (after == count_ || (*this)[after].stamp - a.stamp > limits_.longest_gap) return a.twist;
  const PlacedScan& b = (*this)[after];
  return Vector6((a.T_odom_base.inverse() * b.T_odom_base).log() / to_seconds(b.stamp - a.stamp));
}

const PlacedScan* LocatedScans::nearest(Time t) const {
  if (count_ == 0) return nullptr;
  const std::size_t after = first_after(t);
  if (after == 0) return &(*this)[0];
  if (after == count_) return &newest();
  const PlacedScan &a = (*this)[after - 1], &b = (*this)[after];
  return t - a.stamp <= b.stamp - t ? &a : &b;
}

}  // namespace cairn::labelling
