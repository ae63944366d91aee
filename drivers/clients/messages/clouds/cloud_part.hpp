// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "drivers/clients/messages/field_reader.hpp"
#include "drivers/clients/messages/record.hpp"

// What ScanPart and ThermalPart have in common. Their body is: stamp (8), flags (1, bit 0), zeros (3), epoch (4), pose
// (7 × 8), total (4), first (4), number here (4), then the points as floats.
namespace cairn::clients {

/// Points that fit into one part.
template <class Point>
inline constexpr std::uint32_t kMostInPart = (Record::kMaxBody - (8 + 4 + 4 + 7 * 8 + 3 * 4)) / sizeof(Point);

/// Appends `part` with those of `points` that fit, from `part.first` on. Returns how many these are.
template <class Part, class Point>
std::uint32_t append_cloud(const Part& part, bool flag, std::span<const Point> points, std::vector<std::byte>& out) {
  const auto total = static_cast<std::uint32_t>(std::min<std::size_t>(points.size(), Part::kMaxPoints));
  const std::uint32_t first = std::min(part.first, total), count = std::min(total - first, kMostInPart<Point>);
  append_time(out, part.stamp);
  append_le(out, std::uint32_t{flag});
  append_le(out, part.epoch);
  append_pose(out, part.T_odom_base);
  append_le(out, total);
  append_le(out, first);
  append_le(out, count);
  const auto bytes = std::as_bytes(points.subspan(first, count));
  out.insert(out.end(), bytes.begin(), bytes.end());
  return count;
}

/// Points of finite numbers; with others, `in` is no longer good().
template <class Point>
void read_points(FieldReader& in, std::uint32_t count, std::vector<Point>& points) {
  const auto bytes = in.bytes(count * sizeof(Point));
  points.resize(bytes.size() / sizeof(Point));
  if (points.empty()) return;
  std::memcpy(static_cast<void*>(points.data()), bytes.data(), bytes.size());
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(float)) {
    float number = 0;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    in.require(std::isfinite(number));
  }
}

/// What append_cloud() wrote; look at `in` afterwards.
template <class Part, class Point>
void read_cloud(FieldReader& in, Part& part, bool& flag, std::vector<Point>& points) {
  part.stamp = in.time();
  flag = in.up_to(std::uint32_t{1}) != 0;
  part.epoch = in.number<std::uint32_t>();
  part.T_odom_base = in.pose();
  part.total = in.up_to(Part::kMaxPoints);
  part.first = in.up_to(part.total);
  const auto count = in.up_to(std::min(part.total - part.first, kMostInPart<Point>));
  read_points(in, count, points);
}

}  // namespace cairn::clients
