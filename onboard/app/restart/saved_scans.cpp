// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/saved_scans.hpp"

#include <array>
#include <cstring>
#include <optional>

#include "onboard/app/restart/saved_bytes.hpp"

namespace cairn::app {
namespace {

constexpr std::array<char, 8> kScanMagic{'C', 'A', 'I', 'R', 'N', 'S', 'C', 'N'};
constexpr std::uint32_t kScanVersion = 1;

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));

void append_scan(std::vector<std::byte>& out, const odometry::PlacedScan& scan) {
  append_le<std::int64_t>(out, scan.stamp.time_since_epoch().count());
  append_pose(out, scan.T_odom_base);
  append_le(out, static_cast<std::uint32_t>(scan.points_base.size()));
  const auto points = std::as_bytes(std::span(scan.points_base));
  out.insert(out.end(), points.begin(), points.end());
}

std::optional<odometry::PlacedScan> read_scan(ByteReader& in) {
  const auto stamp = in.read<std::int64_t>();
  const auto pose = read_pose(in);
  const auto count = in.read<std::uint32_t>();
  if (!stamp || !pose || !count) return std::nullopt;
  const auto bytes = in.read_bytes(std::uint64_t{*count} * sizeof(Eigen::Vector3f));
  if (!bytes) return std::nullopt;
  odometry::PlacedScan scan{Time{Duration{*stamp}}, *pose, std::vector<Eigen::Vector3f>(*count)};
  if (*count > 0) std::memcpy(scan.points_base.data()->data(), bytes->data(), bytes->size());
  for (const Eigen::Vector3f& p : scan.points_base)
    if (!p.allFinite()) return std::nullopt;
  return scan;
}

}  // namespace

std::vector<std::byte> encode(const SavedScans& saved) {
  std::vector<std::byte> out;
  append_header(out, {kScanMagic, kScanVersion, saved.epoch, static_cast<std::uint32_t>(saved.scans.size())});
  for (const odometry::PlacedScan& scan : saved.scans) append_scan(out, scan);
  seal(out);
  return out;
}

Result<SavedScans> decode_scans(std::span<const std::byte> bytes) {
  const Error damaged{Errc::kMalformed, "the saved scans are damaged"};
  const auto body = unseal(bytes);
  if (!body) return damaged;
  ByteReader in(*body);
  const auto header = read_header(in);
  if (!header || header->magic != kScanMagic || header->version != kScanVersion) return damaged;
  if (header->count > odometry::RecentScans::kScans) return Error{Errc::kLimit, "too many saved scans"};
  SavedScans saved{header->epoch, {}};
  for (std::uint32_t i = 0; i < header->count; ++i) {
    auto scan = read_scan(in);
    if (!scan) return damaged;
    saved.scans.push_back(std::move(*scan));
  }
  if (in.remaining() != 0) return damaged;
  return saved;
}

}  // namespace cairn::app
