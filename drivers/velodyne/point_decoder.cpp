// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/point_decoder.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/velodyne/trigonometry.hpp"

namespace cairn::velodyne {
namespace {

constexpr double kMaxRawDistance = 65535;

/// Raw distances are compared as integers; `epsilon` lets a gate of 0.4 m keep the raw 200 of 2 mm each.
std::uint32_t raw_at_least(double range_m, double unit_m) {
  constexpr double epsilon = 1e-6;
  return static_cast<std::uint32_t>(std::clamp(std::ceil(range_m / unit_m - epsilon), 1.0, kMaxRawDistance + 1));
}
std::uint32_t raw_at_most(double range_m, double unit_m) {
  constexpr double epsilon = 1e-6;
  return static_cast<std::uint32_t>(std::clamp(std::floor(range_m / unit_m + epsilon), 0.0, kMaxRawDistance));
}

}  // namespace

PointDecoder::PointDecoder(const Model& model, const Gates& gates)
    : model_(model),
      body_(gates.body),
      min_distance_(raw_at_least(gates.min_range_m, model.distance_unit_m)),
      max_distance_(raw_at_most(gates.max_range_m, model.distance_unit_m)),
      firing_duration_(model.firing_offset(0, model.channel_count - 1, false)) {
  for (int c = 0; c < model.channel_count; ++c) {
    const Channel& channel = model.channels[static_cast<std::size_t>(c)];
    const SinCos elevation = sin_cos_deg(channel.elevation_deg);
    const SinCos rotation = sin_cos_deg(channel.rotation_correction_deg);
    const Duration slot = model.firing_offset(0, c, false);
    rays_[static_cast<std::size_t>(c)] = {elevation.cos * rotation.cos,
                                          elevation.cos * rotation.sin,
                                          elevation.sin,
                                          channel.vertical_offset_m,
                                          to_seconds(slot),
                                          static_cast<std::uint32_t>(slot.count()),
                                          channel.ring};
  }
}

Firing PointDecoder::firing(const DataPacket& packet, int index, double rate_deg_s) const {
  const int per_block = model_.sequences_per_block();
  const int block = index / per_block * (packet.dual() ? 2 : 1);
  const int slot = index % per_block * model_.channel_count;
  const Duration offset = model_.firing_offset(block, slot, packet.dual());
  const Duration in_block = offset - model_.firing_offset(block, 0, packet.dual());
  const double azimuth = packet.azimuth[static_cast<std::size_t>(block)] * kAzimuthUnitDeg;
  return {block, slot, offset, wrap_360(azimuth + rate_deg_s * to_seconds(in_block))};
}

void PointDecoder::append(const DataPacket& packet, const Firing& firing, double rate_deg_s, std::uint32_t since_ns,
                          PointCloud& cloud) const {
  const SinCos first = sin_cos_deg(firing.azimuth_deg);
  const double rate_rad_s = rate_deg_s * (std::numbers::pi / 180.0);
  const ReturnType single = packet.mode == ReturnMode::kLast ? ReturnType::kLast : ReturnType::kStrongest;
  for (int c = 0; c < model_.channel_count; ++c) {
    const Ray& ray = rays_[static_cast<std::size_t>(c)];
    const SinCos turn = sin_cos_small(rate_rad_s * ray.slot_s);
    const double cos = first.cos * turn.cos - first.sin * turn.sin;
    const double sin = first.sin * turn.cos + first.cos * turn.sin;
    const Eigen::Vector3d direction{ray.x * cos + ray.y * sin, ray.y * cos - ray.x * sin, ray.z};
    const auto r = packet.at(firing.block, firing.first_slot + c);
    if (!packet.dual()) {
      append_return(r, direction, ray, since_ns, single, cloud);
      continue;
    }
    const auto strongest = packet.at(firing.block + 1, firing.first_slot + c);
    const bool same = strongest.distance == r.distance;
    append_return(strongest, direction, ray, since_ns, same ? ReturnType::kBoth : ReturnType::kStrongest, cloud);
    if (!same) append_return(r, direction, ray, since_ns, ReturnType::kLast, cloud);
  }
}

void PointDecoder::append_return(DataPacket::Return r, const Eigen::Vector3d& direction, const Ray& ray,
                                 std::uint32_t since_ns, ReturnType type, PointCloud& cloud) const {
  if (r.distance < min_distance_ || r.distance > max_distance_) return;
  Eigen::Vector3d p = direction * (r.distance * model_.distance_unit_m);
  p.z() += ray.vertical_offset_m;
  const Eigen::Vector3f point = p.cast<float>();
  if (body_.contains(point)) return;
  cloud.push_back(point, r.reflectivity, since_ns + ray.slot_ns, ray.ring, type);
}

}  // namespace cairn::velodyne
