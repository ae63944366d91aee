// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/calibration/board_points.hpp"

#include <cmath>
#include <random>

namespace cairn::calibration {
namespace {

constexpr double kThick_m = 0.03;  // points so near to a plane belong to it: three times a LiDAR's noise
constexpr int kTrials = 300;

/// normal·p = offset.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double offset = 0;
  [[nodiscard]] bool has(const Eigen::Vector3d& p) const { return std::abs(normal.dot(p) - offset) < kThick_m; }
};

std::size_t count_on(const Plane& plane, const Points& points) {
  std::size_t count = 0;
  for (const Eigen::Vector3d& p : points) count += plane.has(p) ? 1U : 0U;
  return count;
}

}  // namespace

Points near_board(std::span<const Eigen::Vector3d> points, const Board& board, const SE3& T_points_board,
                  const Eigen::Vector3d& eye, const MountTolerance& tolerance) {
  const Eigen::Vector3d middle = T_points_board * board.centre();
  const double reach =
      board.half_diagonal() + tolerance.shift_m + std::sin(tolerance.turn_deg * kDegree) * (middle - eye).norm();
  Points near;
  for (const Eigen::Vector3d& p : points)
    if ((p - middle).squaredNorm() < reach * reach) near.push_back(p);
  return near;
}

Points board_plane(const Points& near, const SE3& T_points_board, const MountTolerance& tolerance) {
  if (near.size() < kLeastPoints) return {};
  const Eigen::Vector3d expected = T_points_board.rotation().col(2);
  const double least_cosine = std::cos(2 * tolerance.turn_deg * kDegree);
  std::mt19937 random(1);
  Plane best;
  std::size_t most = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto pick = [&] { return near[random() % near.size()]; };
    const Eigen::Vector3d a = pick(), b = pick(), c = pick();
    const Eigen::Vector3d across = (b - a).cross(c - a);
    if (!(across.norm() > 1e-4)) continue;
    const Plane plane{.normal = across.normalized(), .offset = across.normalized().dot(a)};
    if (std::abs(plane.normal.dot(expected)) < least_cosine) continue;
    const std::size_t count = count_on(plane, near);
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  if (most < kLeastPoints) return {};
  Points on;
  for (const Eigen::Vector3d& p : near)
    if (best.has(p)) on.push_back(p);
  return on;
}

Points on_squares(const Points& near, const Board& board, const SE3& T_points_board, double depth_m) {
  const SE3 T_board_points = T_points_board.inverse();
  const double s = board.square_m;
  Points on;
  for (const Eigen::Vector3d& p : near) {
    const Eigen::Vector3d q = T_board_points * p;
    if (std::abs(q.z()) < depth_m && q.x() > -s && q.x() < s * board.columns && q.y() > -s && q.y() < s * board.rows)
      on.push_back(p);
  }
  return on;
}

}  // namespace cairn::calibration
