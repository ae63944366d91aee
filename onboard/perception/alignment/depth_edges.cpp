// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/alignment/depth_edges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace cairn::alignment {
namespace {

constexpr float kLongestStep = 0.012F;  // rad between neighbours side by side; sensors have 0.002 … 0.007
constexpr float kSector = 0.006F;       // rad, in which points count as above each other
constexpr float kSameRow = 0.002F;      // rad of elevation; nearer points are of one laser
constexpr float kMostAbove = 0.05F;     // rad between neighbours above each other, at most
constexpr float kNearest = 1.0F;        // m; nearer things have too large a parallax
constexpr float kFarthest = 60.0F;      // m, of the nearer thing
constexpr float kJump_m = 0.5F;         // m, at least
constexpr float kJumpShare = 0.1F;      // of the nearer range, at least
constexpr float kEven = 4.0F;           // times the changes on both sides
constexpr float kTurn = std::numbers::pi_v<float>;

float difference(float a, float b) { return std::abs(std::remainder(a - b, 2 * kTurn)); }

}  // namespace

/// Laser by laser, in the order of time.
void DepthEdgeFinder::sort_side_by_side(const PointCloud& cloud) {
  const bool numbered = std::any_of(cloud.ring.begin(), cloud.ring.end(), [](std::uint8_t r) { return r != 0; });
  if (numbered)
    std::stable_sort(rays_.begin(), rays_.end(),
                     [&](const Ray& a, const Ray& b) { return cloud.ring[a.index] < cloud.ring[b.index]; });
  rows_.clear();
  for (std::uint32_t i = 0; i < rays_.size(); ++i)
    if (i == 0 || (numbered && cloud.ring[rays_[i].index] != cloud.ring[rays_[i - 1].index])) rows_.push_back(i);
}

/// Sector by sector, from below.
void DepthEdgeFinder::sort_above_each_other() {
  const auto sector = [](const Ray& r) { return static_cast<int>(std::floor(r.azimuth / kSector)); };
  std::sort(rays_.begin(), rays_.end(), [&](const Ray& a, const Ray& b) {
    return std::tuple(sector(a), a.elevation, a.index) < std::tuple(sector(b), b.elevation, b.index);
  });
  // Of several points of one laser, the first is enough.
  std::size_t kept = 0;
  rows_.clear();
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const bool begins = kept == 0 || sector(rays_[kept - 1]) != sector(rays_[i]);
    if (!begins && rays_[i].elevation - rays_[kept - 1].elevation < kSameRow) continue;
    if (begins) rows_.push_back(static_cast<std::uint32_t>(kept));
    rays_[kept++] = rays_[i];
  }
  rays_.resize(kept);
}

/// The middle one of the steps between neighbours above each other, rad.
float DepthEdgeFinder::usual_step() const {
  std::vector<float> steps;
  for (std::size_t i = 1; i < rays_.size(); ++i) {
    const float step = rays_[i].elevation - rays_[i - 1].elevation;
    if (step > 0 && step < kMostAbove) steps.push_back(step);
  }
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

void DepthEdgeFinder::scan_rows(EdgeKind kind, float longest_step, const PointCloud& cloud,
                                std::span<const Eigen::Vector3f> points, const Eigen::Matrix3d& R_base_sensor) {
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const std::size_t end = row + 1 < rows_.size() ? rows_[row + 1] : rays_.size();
    for (std::size_t i = rows_[row]; i + 3 < end; ++i) {
      const Ray* r = &rays_[i];
      bool together = true;
      for (int j = 0; j < 3; ++j)
        together = together && std::hypot(difference(r[j].azimuth, r[j + 1].azimuth),
                                          r[j].elevation - r[j + 1].elevation) <= longest_step;
      if (!together) continue;
      const float jump = std::abs(r[1].inverse - r[2].inverse);
      const float beside = std::max(std::abs(r[0].inverse - r[1].inverse), std::abs(r[2].inverse - r[3].inverse));
      const Ray& near = r[1].inverse > r[2].inverse ? r[1] : r[2];
      const Ray& far = r[1].inverse > r[2].inverse ? r[2] : r[1];
      const float range = 1 / near.inverse;
      if (range < kNearest || range > kFarthest || 1 / far.inverse - range < kJump_m + kJumpShare * range ||
          jump < kEven * beside)
        continue;
      const Eigen::Vector3f a = cloud.xyz[near.index] * near.inverse, b = cloud.xyz[far.index] * far.inverse;
      const Eigen::Vector3f across = range * (b - a);
      edges_.push_back({points[near.index], points[near.index] + R_base_sensor.cast<float>() * across, kind});
    }
  }
}

std::span<const DepthEdge> DepthEdgeFinder::find(const PointCloud& cloud, std::span<const Eigen::Vector3f> points_base,
                                                 const Eigen::Matrix3d& R_base_sensor) {
  edges_.clear();
  if (cloud.size() != points_base.size()) return edges_;
  rays_.clear();
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.xyz[i];
    const float range = p.norm();
    if (!(range > 0.1F) || !std::isfinite(range)) continue;
    rays_.push_back({i, std::atan2(p.y(), p.x()), std::asin(std::clamp(p.z() / range, -1.0F, 1.0F)), 1 / range});
  }
  sort_side_by_side(cloud);
  scan_rows(EdgeKind::kUpright, kLongestStep, cloud, points_base, R_base_sensor);
  sort_above_each_other();
  scan_rows(EdgeKind::kLevel, 1.5F * usual_step(), cloud, points_base, R_base_sensor);
  return edges_;
}

}  // namespace cairn::alignment
