// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/saved_bytes.hpp"

#include <xxhash.h>

#include <cmath>

namespace cairn::app {
namespace {

using Pose = std::array<double, 7>;

std::uint64_t hash(std::span<const std::byte> bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

}  // namespace

void append_header(std::vector<std::byte>& out, const SavedHeader& header) {
  append_le(out, header.magic);
  append_le(out, header.version);
  append_le(out, header.epoch);
  append_le(out, header.count);
}

std::optional<SavedHeader> read_header(ByteReader& in) {
  const auto magic = in.read<std::array<char, 8>>();
  const auto version = in.read<std::uint32_t>(), epoch = in.read<std::uint32_t>(), count = in.read<std::uint32_t>();
  if (!magic || !version || !epoch || !count) return std::nullopt;
  return SavedHeader{*magic, *version, *epoch, *count};
}

void append_pose(std::vector<std::byte>& out, const SE3& T) {
  const auto& t = T.translation();
  const auto& q = T.quaternion();
  append_le(out, Pose{t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

std::optional<SE3> read_pose(ByteReader& in) {
  const auto p = in.read<Pose>();
  if (!p) return std::nullopt;
  const Eigen::Quaterniond q((*p)[6], (*p)[3], (*p)[4], (*p)[5]);
  const Eigen::Vector3d t((*p)[0], (*p)[1], (*p)[2]);
  if (!t.allFinite() || !(std::abs(q.norm() - 1) <= 1e-6)) return std::nullopt;
  return SE3(q, t);
}

void seal(std::vector<std::byte>& out) { append_le(out, hash(out)); }

std::optional<std::span<const std::byte>> unseal(std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof(std::uint64_t)) return std::nullopt;
  const auto body = bytes.first(bytes.size() - sizeof(std::uint64_t));
  if (load_le<std::uint64_t>(bytes, body.size()) != hash(body)) return std::nullopt;
  return body;
}

}  // namespace cairn::app
