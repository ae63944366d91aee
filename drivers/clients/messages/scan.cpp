// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/scan.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {
namespace {

constexpr std::size_t kHeadBytes = 8 + 4 + 4 + 7 * 8 + 3 * 4, kPointBytes = 3 * sizeof(float);
constexpr std::uint32_t kMostInPart = (Record::kMaxBody - kHeadBytes) / kPointBytes;

void read_points(FieldReader& in, std::uint32_t count, std::vector<Eigen::Vector3f>& points) {
  const auto bytes = in.bytes(count * kPointBytes);
  points.resize(bytes.size() / kPointBytes);
  if (points.empty()) return;
  std::memcpy(points.front().data(), bytes.data(), bytes.size());
  in.require(std::ranges::all_of(points, [](const Eigen::Vector3f& p) { return p.allFinite(); }));
}

}  // namespace

std::uint32_t encode(const ScanPart& part, std::span<const Eigen::Vector3f> points, std::vector<std::byte>& out) {
  const auto total = static_cast<std::uint32_t>(std::min<std::size_t>(points.size(), ScanPart::kMaxPoints));
  const std::uint32_t first = std::min(part.first, total), count = std::min(total - first, kMostInPart);
  append_time(out, part.stamp);
  append_le(out, std::uint32_t{part.lost});
  append_le(out, part.epoch);
  append_pose(out, part.T_odom_base);
  append_le(out, total);
  append_le(out, first);
  append_le(out, count);
  const auto bytes = std::as_bytes(points.subspan(first, count));
  out.insert(out.end(), bytes.begin(), bytes.end());
  return count;
}

Result<ScanPart> decode_scan(std::span<const std::byte> body) {
  FieldReader in(body);
  ScanPart part;
  part.stamp = in.time();
  part.lost = in.up_to(std::uint32_t{1}) != 0;
  part.epoch = in.number<std::uint32_t>();
  part.T_odom_base = in.pose();
  part.total = in.up_to(ScanPart::kMaxPoints);
  part.first = in.up_to(part.total);
  const auto count = in.up_to(std::min(part.total - part.first, kMostInPart));
  read_points(in, count, part.points_base);
  if (!in.complete()) return in.error("not a part of a scan");
  return part;
}

}  // namespace cairn::clients
