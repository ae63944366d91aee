// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/saved_keyframes.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <optional>
#include <utility>

#include "onboard/app/restart/saved_bytes.hpp"

namespace cairn::app {
namespace {

using visual_odometry::Descriptor;
using visual_odometry::Keyframe;
using visual_odometry::Landmark;

constexpr std::array<char, 8> kKeyframeMagic{'C', 'A', 'I', 'R', 'N', 'K', 'E', 'Y'};
constexpr std::uint32_t kKeyframeVersion = 1;
using Place = std::array<double, 3>;
using Upper = std::array<double, 6>;  // of a symmetric matrix, row by row

void append_keyframe(std::vector<std::byte>& out, const Keyframe& keyframe) {
  append_le<std::int64_t>(out, keyframe.stamp.time_since_epoch().count());
  append_pose(out, keyframe.T_odom_base);
  append_le(out, static_cast<std::uint32_t>(keyframe.landmarks.size()));
  for (std::size_t i = 0; i < keyframe.landmarks.size(); ++i) {
    const Eigen::Vector3d& p = keyframe.landmarks[i].p_odom;
    const Eigen::Matrix3d& c = keyframe.landmarks[i].covariance;
    append_le(out, keyframe.descriptors[i]);
    append_le(out, Place{p.x(), p.y(), p.z()});
    append_le(out, Upper{c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)});
  }
}

std::optional<Landmark> read_landmark(ByteReader& in) {
  const auto p = in.read<Place>();
  const auto c = in.read<Upper>();
  if (!p || !c) return std::nullopt;
  Landmark landmark;
  landmark.p_odom = {(*p)[0], (*p)[1], (*p)[2]};
  landmark.covariance << (*c)[0], (*c)[1], (*c)[2], (*c)[1], (*c)[3], (*c)[4], (*c)[2], (*c)[4], (*c)[5];
  const bool sound = landmark.p_odom.allFinite() && landmark.covariance.allFinite() &&
                     landmark.covariance.llt().info() == Eigen::Success;
  return sound ? std::optional(landmark) : std::nullopt;
}

std::optional<Keyframe> read_keyframe(ByteReader& in) {
  const auto stamp = in.read<std::int64_t>();
  const auto pose = read_pose(in);
  const auto count = in.read<std::uint32_t>();
  if (!stamp || !pose || !count) return std::nullopt;
  Keyframe keyframe{Time{Duration{*stamp}}, *pose, {}, {}};
  for (std::uint32_t i = 0; i < *count; ++i) {
    const auto descriptor = in.read<Descriptor>();
    const auto landmark = read_landmark(in);
    if (!descriptor || !landmark) return std::nullopt;
    keyframe.descriptors.push_back(*descriptor);
    keyframe.landmarks.push_back(*landmark);
  }
  return keyframe;
}

}  // namespace

std::vector<std::byte> encode(const SavedKeyframes& saved) {
  std::vector<std::byte> out;
  append_header(out,
                {kKeyframeMagic, kKeyframeVersion, saved.epoch, static_cast<std::uint32_t>(saved.keyframes.size())});
  for (const Keyframe& keyframe : saved.keyframes) append_keyframe(out, keyframe);
  seal(out);
  return out;
}

Result<SavedKeyframes> decode_keyframes(std::span<const std::byte> bytes) {
  const Error damaged{Errc::kMalformed, "the saved keyframes are damaged"};
  const auto body = unseal(bytes);
  if (!body) return damaged;
  ByteReader in(*body);
  const auto header = read_header(in);
  if (!header || header->magic != kKeyframeMagic || header->version != kKeyframeVersion) return damaged;
  if (header->count > visual_odometry::PlaceMemory::kPlaces) return Error{Errc::kLimit, "too many saved keyframes"};
  SavedKeyframes saved{header->epoch, {}};
  for (std::uint32_t i = 0; i < header->count; ++i) {
    auto keyframe = read_keyframe(in);
    if (!keyframe) return damaged;
    saved.keyframes.push_back(std::move(*keyframe));
  }
  if (in.remaining() != 0) return damaged;
  return saved;
}

}  // namespace cairn::app
