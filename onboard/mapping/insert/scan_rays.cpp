// SPDX-License-Identifier: Apache-2.0
// Every rounding here repeats one of OctoMap's, in the same order and with the same types; see NOTES.md.
#include "onboard/mapping/insert/scan_rays.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>

namespace cairn::mapping {
namespace {

constexpr int kKeys = 65536;         // per axis: OctoMap's keys have 16 bits
constexpr int kCentreKey = 32768;    // of coordinate 0
constexpr std::size_t kBatch = 512;  // rays that are prepared before they march: they fit into the first-level cache
constexpr std::uint64_t kStepsOfSlack = 3;  // a ray may overshoot its end voxel by one along each axis

int sign_of(float x) { return x > 0.0F ? 1 : x < 0.0F ? -1 : 0; }

}  // namespace

Result<ScanRays::Counts> ScanRays::prepare(std::span<const Eigen::Vector3f> points_map,
                                           const Eigen::Vector3f& origin_map, Footprint& footprint) {
  hits_.clear();
  targets_.clear();
  for (std::vector<Target>* ends : {&hits_, &targets_}) ends->reserve(std::bit_ceil(points_map.size()));
  origin_ = {origin_map.x(), origin_map.y(), origin_map.z()};
  if (!key_of(origin_, origin_key_))
    return Error{Errc::kLimit, "the sensor is outside of the map", {}, {}, "use coarser voxels"};

  Counts counts;
  VoxelKey last{-1, -1, -1};
  for (const Eigen::Vector3f& p : points_map) {
    VoxelKey key;
    if (!key_of(octomap::point3d(p.x(), p.y(), p.z()), key)) {
      ++(p.allFinite() ? counts.outside_map : counts.not_finite);
    } else if (key != last) {
      add_point(key);
      last = key;
    }
  }
  footprint.reset(grid());
  for (const Target& hit : hits_)
    if (footprint.mark_occupied(footprint.grid().index(hit.key)) && hit.key != origin_key_) targets_.push_back(hit);
  if (steps_of_rays() > kMaxSteps)
    return Error{Errc::kLimit, "the rays of the scan are too long", {}, {}, "limit the range or use coarser voxels"};
  if (footprint.overflown())
    return Error{Errc::kLimit, "the scan touches too much space", {}, {}, "limit the range or use coarser voxels"};
  return counts;
}

void ScanRays::march(std::size_t first, std::size_t last, MarchRays march_rays, Footprint& footprint,
                     const SemanticOcTree* surfaces) const {
  if (first >= last) return;
  const std::uint64_t origin = footprint.grid().index(origin_key_);
  footprint.flat() ? footprint.mark_free<true>(origin) : footprint.mark_free<false>(origin);
  std::optional<SurfaceBeams> beams;
  if (surfaces != nullptr) beams.emplace(*surfaces);
  std::array<Ray, kBatch> rays;
  std::array<BeamEnd, kBatch> ends;
  for (; first < last; first += kBatch) {
    const std::size_t n = std::min(kBatch, last - first);
    for (std::size_t i = 0; i < n; ++i) rays[i] = ray_to(targets_[first + i], footprint.grid());
    if (beams) {
      for (std::size_t i = 0; i < n; ++i) ends[i] = end_of(targets_[first + i]);
      beams->shorten(std::span(rays).first(n), std::span(ends).first(n));
    }
    march_rays(std::span(rays).first(n), origin, footprint);
  }
}

/// OctoMap's coordToKeyChecked(), without its undefined conversion of NaN and of huge numbers to
/// int.
bool ScanRays::key_of(double coordinate, int& key) const {
  const double cell = resolution_factor_ * coordinate;
  if (!(cell >= -kCentreKey && cell < kKeys - kCentreKey)) return false;
  const int towards_zero = static_cast<int>(cell);  // std::floor() is a function call on machines without SSE 4.1
  key = towards_zero - (towards_zero > cell ? 1 : 0) + kCentreKey;
  return true;
}

bool ScanRays::key_of(const octomap::point3d& point, VoxelKey& key) const {
  return key_of(point.x(), key[0]) && key_of(point.y(), key[1]) && key_of(point.z(), key[2]);
}

void ScanRays::add_point(const VoxelKey& key) {
  const octomap::point3d centre(centre_of(key[0]), centre_of(key[1]), centre_of(key[2]));
  if (max_range_ < 0.0 || (centre - origin_).norm() <= max_range_) {
    if (VoxelKey end_key; key_of(centre, end_key)) hits_.push_back({centre, end_key});
    return;
  }
  const octomap::point3d direction = (centre - origin_).normalized();
  const octomap::point3d end = origin_ + direction * static_cast<float>(max_range_);
  if (VoxelKey end_key; key_of(end, end_key) && end_key != origin_key_) targets_.push_back({end, end_key});
}

std::uint64_t ScanRays::steps_of_rays() const {
  std::uint64_t steps = 0;
  for (const Target& target : targets_) {
    steps += kStepsOfSlack;
    for (std::size_t a = 0; a < 3; ++a) steps += static_cast<std::uint64_t>(std::abs(target.key[a] - origin_key_[a]));
  }
  return steps;
}

BrickGrid ScanRays::grid() const {
  VoxelKey lo = origin_key_, hi = origin_key_;
  for (const auto* targets : {&hits_, &targets_})
    for (const Target& target : *targets)
      for (std::size_t a = 0; a < 3; ++a) {
        lo[a] = std::min(lo[a], target.key[a]);
        hi[a] = std::max(hi[a], target.key[a]);
      }
  for (std::size_t a = 0; a < 3; ++a) {
    lo[a] -= 2;  // rounding may carry a ray past its end voxel
    hi[a] += 2;
  }
  return {lo, hi};
}

/// The first half of computeRayKeys().
Ray ScanRays::ray_to(const Target& target, const BrickGrid& grid) const {
  octomap::point3d direction = target.end - origin_;
  const auto length = static_cast<float>(direction.norm());
  direction /= length;
  Ray ray;
  ray.length = length;
  ray.end = grid.index(target.key);
  for (unsigned a = 0; a < 3; ++a) {
    const int sign = sign_of(direction(a));
    ray.step[a] = grid.axis_step(a, sign);
    ray.t_max[a] = ray.t_delta[a] = std::numeric_limits<double>::max();
    if (sign == 0) continue;
    double border = exact_centre_of(origin_key_[a]);
    border += static_cast<float>(sign * resolution_ * 0.5);
    ray.t_max[a] = (border - static_cast<double>(origin_(a))) / static_cast<double>(direction(a));
    ray.t_delta[a] = resolution_ / std::fabs(static_cast<double>(direction(a)));
  }
  return ray;
}

BeamEnd ScanRays::end_of(const Target& target) const {
  const octomap::point3d way = target.end - origin_;
  return {target.key, {sign_of(way.x()), sign_of(way.y()), sign_of(way.z())}};
}

}  // namespace cairn::mapping
