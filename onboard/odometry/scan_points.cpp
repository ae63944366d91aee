// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/scan_points.hpp"

#include <algorithm>
#include <cmath>

#include "onboard/odometry/deskew.hpp"

namespace cairn {
namespace {

// A revolution takes at most 0.2 s (5 Hz); an older point has a broken stamp.
constexpr double kMaxAge = 0.25;
constexpr float kWidestSpacing = 3.0F;

bool finite(const Eigen::Vector3f& p) { return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()); }

/// Elevation in steps of 0.4° near the horizon, for clouds that do not say which laser saw a point.
std::uint8_t ring_of(const Eigen::Vector3f& p) {
  return static_cast<std::uint8_t>(145.0F + 140.0F * p.z() / std::max(p.norm(), 1e-3F));
}

bool knows_rings(const PointCloud& cloud) {
  return cloud.ring.size() == cloud.size() &&
         std::any_of(cloud.ring.begin(), cloud.ring.end(), [](std::uint8_t ring) { return ring != 0; });
}

}  // namespace

ScanPoints::ScanPoints(const Limits& limits) : limits_(limits), keypoint_spacing_m_(3 * limits.dense_spacing_m) {
  keypoints_.reserve(2 * limits.keypoints);
}

void ScanPoints::clear(std::size_t points) {
  points_lidar_.clear();
  age_s_.clear();
  ring_.clear();
  in_range_.clear();
  points_lidar_.reserve(points);
  age_s_.reserve(points);
  ring_.reserve(points);
  in_range_.reserve(points);
}

void ScanPoints::take(const Scan& scan) {
  const PointCloud& cloud = scan.cloud;
  clear(cloud.size());
  const double span_s = to_seconds(scan.valid.end - scan.valid.start);
  duration_s_ = scan.deskewed ? 0.0 : std::clamp(span_s, 0.0, kMaxAge);
  const bool rings_known = knows_rings(cloud);
  const float nearest = limits_.min_range_m * limits_.min_range_m, farthest = limits_.max_range_m * limits_.max_range_m;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.xyz[i];
    if (!finite(p)) continue;
    const float squared = p.squaredNorm();
    if (squared >= nearest && squared <= farthest)
      in_range_.push_back(static_cast<std::uint32_t>(points_lidar_.size()));
    const double age = scan.deskewed ? 0.0 : std::clamp(span_s - 1e-9 * cloud.offset_ns[i], 0.0, duration_s_);
    points_lidar_.push_back(p);
    age_s_.push_back(static_cast<float>(age));
    ring_.push_back(rings_known ? cloud.ring[i] : ring_of(p));
  }
  choose_keypoints();
}

void ScanPoints::choose_keypoints() {
  dense_ = thin_(points_lidar_, in_range_, limits_.dense_spacing_m);
  const auto chosen = thin_further_(points_lidar_, dense_, keypoint_spacing_m_);
  const std::size_t stride = chosen.size() / (2 * limits_.keypoints) + 1;
  keypoints_.clear();
  for (std::size_t i = 0; i < chosen.size(); i += stride)
    keypoints_.push_back({points_lidar_[chosen[i]], age_s_[chosen[i]]});
  // The next scan will look much the same: let the spacing follow.
  const double ratio = static_cast<double>(chosen.size()) / static_cast<double>(limits_.keypoints);
  if (ratio > 1.1) keypoint_spacing_m_ *= ratio > 1.5 ? 1.2F : 1.05F;
  if (ratio < 0.9) keypoint_spacing_m_ /= 1.05F;
  keypoint_spacing_m_ = std::clamp(keypoint_spacing_m_, limits_.dense_spacing_m, kWidestSpacing);
}

std::span<const Eigen::Vector3f> ScanPoints::deskew(const Vector6& twist, const SE3& T_base_lidar, Workers& workers) {
  constexpr std::size_t kChunk = 4096;
  const Deskew to_stamp(twist, T_base_lidar, duration_s_);
  points_base_.resize(points_lidar_.size());
  workers.for_each((points_lidar_.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(points_lidar_.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) points_base_[i] = to_stamp(points_lidar_[i], age_s_[i]);
  });
  return points_base_;
}

}  // namespace cairn
