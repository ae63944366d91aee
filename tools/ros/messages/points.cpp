// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/points.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string_view>

namespace cairn::ros {
namespace {

static_assert(std::endian::native == std::endian::little, "points are copied as they lie in memory");

constexpr std::uint8_t kFloat32 = 7;  // sensor_msgs/PointField

/// Points that are a float for each field.
template <class Point>
PointCloud2 cloud_of(std::span<const Point> points, std::span<const std::string_view> fields, Arena& arena) {
  PointCloud2 message{};
  message.height = 1;
  message.width = static_cast<std::uint32_t>(points.size());
  const auto out = arena.sequence(message.fields, fields.size());
  for (std::uint32_t i = 0; i < fields.size(); ++i)
    out[i] = {.name = arena.text(fields[i]), .offset = i * 4, .datatype = kFloat32, .count = 1};
  message.point_step = sizeof(Point);
  message.row_step = message.point_step * message.width;
  const auto data = arena.sequence(message.data, message.row_step);
  if (!data.empty()) std::memcpy(data.data(), std::as_bytes(points).data(), data.size());
  return message;
}

}  // namespace

PointCloud2 points_of(const client::ScanMessage& scan, const Frames& frames, Duration utc_offset, Arena& arena) {
  static_assert(sizeof(Eigen::Vector3f) == 12);
  constexpr std::array<std::string_view, 3> kFields{"x", "y", "z"};
  PointCloud2 message = cloud_of<Eigen::Vector3f>(scan.points_base, kFields, arena);
  message.header = header_of(scan.stamp, utc_offset, frames.base_link, arena);
  message.is_dense = std::ranges::all_of(scan.points_base, [](const Eigen::Vector3f& p) { return p.allFinite(); });
  return message;
}

PointCloud2 points_of(const client::ThermalMessage& cloud, const Frames& frames, Duration utc_offset, Arena& arena) {
  static_assert(sizeof(ThermalPoint) == 16);
  const std::array<std::string_view, 4> fields{"x", "y", "z", cloud.celsius ? "temperature" : "counts"};
  PointCloud2 message = cloud_of<ThermalPoint>(cloud.points, fields, arena);
  message.header = header_of(cloud.stamp, utc_offset, frames.base_link, arena);
  message.is_dense = true;
  return message;
}

}  // namespace cairn::ros
