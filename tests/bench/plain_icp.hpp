// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "hal/point_cloud.hpp"
#include "hal/se3.hpp"

namespace cairn::bench {

/// A plain scan-to-map ICP to compare with, after KISS-ICP (Vizzo et al., RA-L 2023) with its published settings:
/// constant velocity prediction, deskewing by the last step, an adaptive threshold, point-to-point steps with a
/// Geman-McClure weight, a map of 20 points a voxel. Written for comparison, not for speed.
class PlainIcp {
 public:
  /// T_odom_lidar at the scan's end; the first scan's is the identity.
  const SE3& update(const Scan& scan) {
    const std::vector<Eigen::Vector3d> points = deskewed(scan);
    const auto for_map = thinned(points, 0.5 * kVoxel_m);
    const auto keypoints = thinned(for_map, 1.5 * kVoxel_m);
    const SE3 predicted = T_ * step_;
    const SE3 found = voxels_.empty() ? predicted : align(keypoints, predicted, threshold());
    learn(predicted.inverse() * found);
    step_ = T_.inverse() * found;
    T_ = found;
    add(for_map);
    return T_;
  }

 private:
  static constexpr double kVoxel_m = 1.0, kRange_m = 100, kFirstThreshold_m = 2.0, kLeastMotion_m = 0.1;
  static constexpr std::size_t kPerVoxel = 20;
  using Key = std::int64_t;

  static Key key(const Eigen::Vector3d& p, double edge) {
    const auto part = [&](double x) { return static_cast<Key>(std::floor(x / edge)) & 0x1FFFFF; };
    return part(p.x()) << 42 | part(p.y()) << 21 | part(p.z());
  }

  [[nodiscard]] std::vector<Eigen::Vector3d> deskewed(const Scan& scan) const {
    const double span = to_seconds(scan.valid.end - scan.valid.start);
    const Vector6 motion = step_.log();
    std::vector<Eigen::Vector3d> out;
    for (std::size_t i = 0; i < scan.cloud.xyz.size(); ++i) {
      const Eigen::Vector3f& p = scan.cloud.xyz[i];
      if (!p.allFinite() || p.norm() < 0.5F || p.norm() > static_cast<float>(kRange_m)) continue;
      const double age = scan.deskewed ? 0 : (span - 1e-9 * scan.cloud.offset_ns[i]) / span;
      out.push_back(SE3::exp(-age * motion) * p.cast<double>());
    }
    return out;
  }
  static std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points, double edge) {
    std::unordered_set<Key> seen;
    std::vector<Eigen::Vector3d> out;
    for (const Eigen::Vector3d& p : points)
      if (seen.insert(key(p, edge)).second) out.push_back(p);
    return out;
  }
  [[nodiscard]] double threshold() const { return std::sqrt(squared_ / count_); }
  void learn(const SE3& deviation) {
    const double moved = 2 * kRange_m * std::sin(0.5 * rotation_angle(deviation)) + deviation.translation().norm();
    if (moved <= kLeastMotion_m) return;
    squared_ += moved * moved;
    ++count_;
  }
  [[nodiscard]] const Eigen::Vector3d* nearest(const Eigen::Vector3d& p, double within) const {
    const Eigen::Vector3d* best = nullptr;
    double least = within * within;
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3d shift(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const auto voxel = voxels_.find(key(p + kVoxel_m * shift, kVoxel_m));
      if (voxel == voxels_.end()) continue;
      for (const Eigen::Vector3d& q : voxel->second) {
        if ((q - p).squaredNorm() >= least) continue;
        least = (q - p).squaredNorm();
        best = &q;
      }
    }
    return best;
  }
  [[nodiscard]] SE3 align(const std::vector<Eigen::Vector3d>& points, SE3 T, double sigma) const {
    for (int i = 0; i < 500; ++i) {
      Matrix6 H = Matrix6::Zero();
      Vector6 g = Vector6::Zero();
      for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector3d at = T * p;
        const Eigen::Vector3d* q = nearest(at, 3 * sigma);
        if (q == nullptr) continue;
        const Eigen::Vector3d r = at - *q;
        const double k = sigma / 3, w = k * k / ((k + r.squaredNorm()) * (k + r.squaredNorm()));
        Eigen::Matrix<double, 3, 6> J;
        J << Eigen::Matrix3d::Identity(), -skew(at);
        H += w * J.transpose() * J;
        g += w * J.transpose() * r;
      }
      const Vector6 step = -H.ldlt().solve(g);
      if (!step.allFinite()) return T;
      T = SE3::exp(step) * T;
      if (step.norm() < 1e-4) break;
    }
    return T;
  }
  static Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
  }
  void add(const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d q = T_ * p;
      auto& voxel = voxels_[key(q, kVoxel_m)];
      if (voxel.size() < kPerVoxel) voxel.push_back(q);
    }
    std::erase_if(voxels_, [&](const auto& v) { return (v.second.front() - T_.translation()).norm() > kRange_m; });
  }

  SE3 T_, step_;
  double squared_ = kFirstThreshold_m * kFirstThreshold_m;
  int count_ = 1;
  std::unordered_map<Key, std::vector<Eigen::Vector3d>> voxels_;
};

}  // namespace cairn::bench
