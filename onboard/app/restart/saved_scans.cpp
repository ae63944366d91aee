// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/saved_scans.hpp"

#include <xxhash.h>

#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "hal/bytes.hpp"

namespace cairn::app {
namespace {

constexpr std::array<char, 8> kMagic{'C', 'A', 'I', 'R', 'N', 'S', 'C', 'N'};
constexpr std::uint32_t kVersion = 1;
using Pose = std::array<double, 7>;

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));

std::uint64_t hash(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

Pose numbers_of(const SE3& T) {
  const auto& t = T.translation();
  const auto& q = T.quaternion();
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

std::optional<SE3> pose_of(const Pose& p) {
  const Eigen::Quaterniond q(p[6], p[3], p[4], p[5]);
  const Eigen::Vector3d t(p[0], p[1], p[2]);
  if (!t.allFinite() || !(std::abs(q.norm() - 1) <= 1e-6)) return std::nullopt;
  return SE3(q, t);
}

void append(std::vector<std::byte>& out, const odometry::PlacedScan& scan) {
  append_le<std::int64_t>(out, scan.stamp.time_since_epoch().count());
  append_le(out, numbers_of(scan.T_odom_base));
  append_le(out, static_cast<std::uint32_t>(scan.points_base.size()));
  const auto points = std::as_bytes(std::span(scan.points_base));
  out.insert(out.end(), points.begin(), points.end());
}

std::optional<odometry::PlacedScan> read_scan(ByteReader& in) {
  const auto stamp = in.read<std::int64_t>();
  const auto numbers = in.read<Pose>();
  const auto count = in.read<std::uint32_t>();
  if (!stamp || !numbers || !count) return std::nullopt;
  const auto pose = pose_of(*numbers);
  const auto bytes = in.read_bytes(std::uint64_t{*count} * sizeof(Eigen::Vector3f));
  if (!pose || !bytes) return std::nullopt;
  odometry::PlacedScan scan{Time{Duration{*stamp}}, *pose, std::vector<Eigen::Vector3f>(*count)};
  if (*count > 0) std::memcpy(scan.points_base.data()->data(), bytes->data(), bytes->size());
  for (const Eigen::Vector3f& p : scan.points_base)
    if (!p.allFinite()) return std::nullopt;
  return scan;
}

}  // namespace

std::vector<std::byte> encode(const SavedScans& saved) {
  std::vector<std::byte> out;
  append_le(out, kMagic);
  append_le(out, kVersion);
  append_le(out, saved.epoch);
  append_le(out, static_cast<std::uint32_t>(saved.scans.size()));
  for (const odometry::PlacedScan& scan : saved.scans) append(out, scan);
  append_le(out, hash(out));
  return out;
}

Result<SavedScans> decode_scans(std::span<const std::byte> bytes) {
  const Error damaged{Errc::kMalformed, "the saved scans are damaged"};
  if (bytes.size() < sizeof(std::uint64_t)) return damaged;
  const auto body = bytes.first(bytes.size() - sizeof(std::uint64_t));
  if (load_le<std::uint64_t>(bytes, body.size()) != hash(body)) return damaged;
  ByteReader in(body);
  const auto magic = in.read<std::array<char, 8>>();
  const auto version = in.read<std::uint32_t>(), epoch = in.read<std::uint32_t>(), count = in.read<std::uint32_t>();
  if (!magic || *magic != kMagic || !version || *version != kVersion || !epoch || !count) return damaged;
  if (*count > odometry::RecentScans::kScans) return Error{Errc::kLimit, "too many saved scans"};
  SavedScans saved{*epoch, {}};
  for (std::uint32_t i = 0; i < *count; ++i) {
    auto scan = read_scan(in);
    if (!scan) return damaged;
    saved.scans.push_back(std::move(*scan));
  }
  if (in.remaining() != 0) return damaged;
  return saved;
}

}  // namespace cairn::app
