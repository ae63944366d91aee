// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/scan_preparation.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::odometry {
namespace {

// A revolution of a spinning LiDAR takes at most 0.2 s (VLP-16 user manual: 5 to 20 Hz). An older
// point has a wrong stamp.
constexpr double kMaxAge_s = 0.25;

bool finite(const Eigen::Vector3f& p) { return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()); }

}  // namespace

ScanPreparation::ScanPreparation(const OdometryConfig& config)
    : min_squared_range_m2_(static_cast<float>(config.min_range_m * config.min_range_m)),
      max_squared_range_m2_(static_cast<float>(config.max_range_m * config.max_range_m)) {}

Result<void> ScanPreparation::check(const Scan& scan) {
  const PointCloud& cloud = scan.cloud;
  if (cloud.xyz.size() > kMaxPoints) return Error{Errc::kLimit, "scan has too many points"};
  if (cloud.offset_ns.size() != cloud.xyz.size() && !scan.deskewed)
    return Error{Errc::kMalformed, "scan has points without a firing time"};
  return {};
}

void ScanPreparation::clear(std::size_t points) {
  out_.points_lidar.clear();
  out_.age_s.clear();
  out_.in_range.clear();
  out_.points_lidar.reserve(points);
  out_.age_s.reserve(points);
  out_.in_range.reserve(points);
}

const PreparedScan& ScanPreparation::prepare(const Scan& scan) {
  const std::vector<Eigen::Vector3f>& xyz = scan.cloud.xyz;
  const double span_s = to_seconds(scan.valid.end - scan.valid.start);
  out_.stamp = scan.valid.end;
  out_.duration_s = scan.deskewed ? 0.0 : std::clamp(span_s, 0.0, kMaxAge_s);
  clear(xyz.size());
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    if (!finite(xyz[i])) continue;
    const double age = scan.deskewed ? 0.0 : std::clamp(span_s - 1e-9 * scan.cloud.offset_ns[i], 0.0, out_.duration_s);
    const float squared = xyz[i].squaredNorm();
    if (squared >= min_squared_range_m2_ && squared <= max_squared_range_m2_)
      out_.in_range.push_back(static_cast<std::uint32_t>(out_.points_lidar.size()));
    out_.points_lidar.push_back(xyz[i]);
    out_.age_s.push_back(static_cast<float>(age));
  }
  return out_;
}

const PreparedScan& ScanPreparation::prepare(const PlacedScan& scan, const SE3& T_base_lidar) {
  const SE3 T_lidar_base = T_base_lidar.inverse();
  out_.stamp = scan.stamp;
  out_.duration_s = 0;
  clear(scan.points_base.size());
  for (const Eigen::Vector3f& p : scan.points_base) {
    out_.in_range.push_back(static_cast<std::uint32_t>(out_.points_lidar.size()));
    out_.points_lidar.push_back((T_lidar_base * p.cast<double>()).cast<float>());
  }
  out_.age_s.assign(out_.points_lidar.size(), 0);
  return out_;
}

}  // namespace cairn::odometry
