// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/points.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>

namespace cairn::ros {
namespace {

static_assert(std::endian::native == std::endian::little, "points are copied as they lie in memory");
using Point = Eigen::Vector3f;
static_assert(sizeof(Point) == 12);

constexpr std::uint8_t kFloat32 = 7;  // sensor_msgs/PointField
constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};

}  // namespace

PointCloud2 points_of(const client::ScanMessage& scan, const Frames& frames, Duration utc_offset, Arena& arena) {
  PointCloud2 message{};
  message.header = header_of(scan.stamp, utc_offset, frames.base_link, arena);
  message.height = 1;
  message.width = static_cast<std::uint32_t>(scan.points_base.size());
  const auto fields = arena.sequence(message.fields, kAxes.size());
  for (std::uint32_t i = 0; i < kAxes.size(); ++i)
    fields[i] = {.name = arena.text(kAxes[i]), .offset = i * 4, .datatype = kFloat32, .count = 1};
  message.point_step = sizeof(Point);
  message.row_step = message.point_step * message.width;
  const auto data = arena.sequence(message.data, message.row_step);
  if (!data.empty()) std::memcpy(data.data(), scan.points_base.front().data(), data.size());
  message.is_dense = std::ranges::all_of(scan.points_base, [](const Point& p) { return p.allFinite(); });
  return message;
}

}  // namespace cairn::ros
