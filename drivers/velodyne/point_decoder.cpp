// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/point_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

inline void PointDecoder::Batch::add(const Eigen::Vector3f& p, float intensity, std::uint32_t offset_ns,
                                     std::uint8_t ring, ReturnType type) {
  xyz_[size_] = p;
  intensity_[size_] = intensity;
  offset_ns_[size_] = offset_ns;
  ring_[size_] = ring;
  return_type_[size_] = type;
  ++size_;
}

void PointDecoder::Batch::append_to(PointCloud& cloud) const {
  const auto append = [n = size_](const auto& from, auto& to) { to.insert(to.end(), from.data(), from.data() + n); };
  append(xyz_, cloud.xyz);
  append(intensity_, cloud.intensity);
  append(offset_ns_, cloud.offset_ns);
  append(ring_, cloud.ring);
  append(return_type_, cloud.return_type);
}

PointDecoder::Places PointDecoder::places(const Model& model, bool dual) {
  Places out;
  for (int block = 0; block < kBlocks; block += dual ? 2 : 1) {
    for (int slot = 0; slot < kBlockChannels; slot += model.channel_count) {
      const auto i = static_cast<std::size_t>(out.count++);
      out.firings[i] = {block, slot, model.firing_offset(block, slot, dual), 0};
      out.since_block_s[i] = to_seconds(out.firings[i].offset - model.firing_offset(block, 0, dual));
    }
  }
  return out;
}

PointDecoder::PointDecoder(const Model& model, const Gates& gates)
    : model_(model),
      min_distance_(raw_at_least(gates.min_range_m, model.distance_unit_m)),
      max_distance_(raw_at_most(gates.max_range_m, model.distance_unit_m)),
      firing_duration_(model.firing_offset(0, model.channel_count - 1, false)),
      places_{places(model, false), places(model, true)} {
  if (!gates.body.isEmpty()) body_ = gates.body;
  for (int c = 0; c < model.channel_count; ++c) {
    const Channel& channel = model.channels[static_cast<std::size_t>(c)];
    const SinCos elevation = sin_cos_deg(channel.elevation_deg);
    const SinCos rotation = sin_cos_deg(channel.rotation_correction_deg);
    const Duration slot = model.firing_offset(0, c, false);
    resting_[static_cast<std::size_t>(c)] = {elevation.cos * rotation.cos,
                                             elevation.cos * rotation.sin,
                                             elevation.sin,
                                             channel.vertical_offset_m,
                                             static_cast<std::uint32_t>(slot.count()),
                                             channel.ring};
  }
  rays_ = resting_;
}

void PointDecoder::set_rate(double rate_deg_s) {
  rate_deg_s_ = rate_deg_s;
  const double rad_per_ns = rate_deg_s * (std::numbers::pi / 180.0) * 1e-9;
  for (std::size_t c = 0; c < static_cast<std::size_t>(model_.channel_count); ++c) {
    const SinCos turn = sin_cos_small(rad_per_ns * resting_[c].slot_ns);
    rays_[c].x = resting_[c].x * turn.cos + resting_[c].y * turn.sin;
    rays_[c].y = resting_[c].y * turn.cos - resting_[c].x * turn.sin;
  }
}

Firing PointDecoder::firing(const DataPacket& packet, int index) const {
  const Places& places = places_[packet.dual() ? 1 : 0];
  const auto i = static_cast<std::size_t>(index);
  Firing firing = places.firings[i];
  const double block_azimuth = packet.azimuth[static_cast<std::size_t>(firing.block)] * kAzimuthUnitDeg;
  firing.azimuth_deg = wrap_360(block_azimuth + rate_deg_s_ * places.since_block_s[i]);
  return firing;
}

void PointDecoder::append(const DataPacket& packet, const Firing& firing, std::uint32_t since_ns, PointCloud& cloud) {
  batch_.clear();
  const SinCos azimuth = sin_cos_deg(firing.azimuth_deg);
  const bool dual = packet.dual();
  const ReturnType of_equals = dual                               ? ReturnType::kBoth
                               : packet.mode == ReturnMode::kLast ? ReturnType::kLast
                                                                  : ReturnType::kStrongest;
  for (int c = 0; c < model_.channel_count; ++c) {
    const Ray& ray = rays_[static_cast<std::size_t>(c)];
    const auto last = packet.at(firing.block, firing.first_slot + c);
    const auto strongest = dual ? packet.at(firing.block + 1, firing.first_slot + c) : last;
    const bool equal = strongest.distance == last.distance;
    add_return(strongest, ray, azimuth, since_ns, equal ? of_equals : ReturnType::kStrongest);
    if (!equal) add_return(last, ray, azimuth, since_ns, ReturnType::kLast);
  }
  batch_.append_to(cloud);
}

inline void PointDecoder::add_return(DataPacket::Return r, const Ray& ray, const SinCos& azimuth,
                                     std::uint32_t since_ns, ReturnType type) {
  if (r.distance < min_distance_ || r.distance > max_distance_) return;
  const double d = r.distance * model_.distance_unit_m;
  const Eigen::Vector3d p(d * (ray.x * azimuth.cos + ray.y * azimuth.sin),
                          d * (ray.y * azimuth.cos - ray.x * azimuth.sin), d * ray.z + ray.vertical_offset_m);
  const Eigen::Vector3f point = p.cast<float>();
  if (body_ && body_->contains(point)) return;
  batch_.add(point, r.reflectivity, since_ns + ray.slot_ns, ray.ring, type);
}

}  // namespace cairn::velodyne
