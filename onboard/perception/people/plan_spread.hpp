// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace cairn::people {

/// How points lie in plan, without their heights.
class PlanSpread {
 public:
  /// Metres.
  void add(const Eigen::Vector2f& point) {
    if (count_ == 0) origin_ = point.cast<double>();
    const Eigen::Vector2d p = point.cast<double>() - origin_;
    sum_ += p;
    squares_ += products(p, p);
    ++count_;
  }
  /// All points of another spread, of one point or more.
  void add(const PlanSpread& other) {
    if (count_ == 0) origin_ = other.origin_;
    const Eigen::Vector2d to = other.origin_ - origin_;
    squares_ += other.squares_ + 2 * products(to, other.sum_) + other.count_ * products(to, to);
    sum_ += other.sum_ + other.count_ * to;
    count_ += other.count_;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }
  /// m; of one point or more.
  [[nodiscard]] Eigen::Vector2d middle() const { return origin_ + sum_ / count_; }
  /// Whether the standard deviation of one point or more is at least `along_m` along a straight line, and less than
  /// `across_m` across it.
  [[nodiscard]] bool on_a_line(double along_m, double across_m) const {
    const Eigen::Vector3d v = variance();
    const double half = 0.5 * (v.x() + v.z()), apart = std::hypot(0.5 * (v.x() - v.z()), v.y());
    return half + apart > along_m * along_m && half - apart < across_m * across_m;
  }

 private:
  [[nodiscard]] Eigen::Vector3d variance() const {
    const Eigen::Vector2d mean = sum_ / count_;
    return squares_ / count_ - products(mean, mean);
  }
  /// xx, the mean of both xy, yy.
  static Eigen::Vector3d products(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return {a.x() * b.x(), 0.5 * (a.x() * b.y() + a.y() * b.x()), a.y() * b.y()};
  }

  Eigen::Vector2d origin_{0, 0}, sum_{0, 0};  // sums are from the first point, which is near: no digits are lost
  Eigen::Vector3d squares_{0, 0, 0};
  std::uint32_t count_ = 0;
};

}  // namespace cairn::people
