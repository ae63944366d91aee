// SPDX-License-Identifier: Apache-2.0
#include "tools/protocol/methods/starts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn::protocol {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::vector<Start> make_starts() {
  std::vector<Start> all;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int yaw = -2; yaw <= 2; ++yaw) all.push_back({1.0 * x, 1.0 * y, 7.5 * yaw});
  return all;
}

}  // namespace

double Start::distance_m() const { return std::hypot(x_m, y_m); }

const std::vector<Start>& starts() {
  static const std::vector<Start> all = make_starts();
  return all;
}

std::vector<int> chosen_starts(int count) {
  std::vector<int> chosen;
  for (int n = 0; n < std::min(count, kStarts); ++n) {
    // Digits to the base of 5; the combinations make an orthogonal array of every prefix of 5 and 25.
    const int a = n % 5, b = n / 5 % 5, c = n / 25;
    const auto step = [](int sum) { return (kExactStart % 5 + sum) % 5; };
    chosen.push_back(25 * step(a) + 5 * step(2 * a + b) + step(3 * a + b + c));
  }
  return chosen;
}

SE3 start_pose(const SE3& T_a_b, const Start& start) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(start.yaw_deg * kDegree, Eigen::Vector3d::UnitZ()));
  return {T_a_b.quaternion() * turn, T_a_b.translation() + Eigen::Vector3d(start.x_m, start.y_m, 0)};
}

PoseError error_of(const SE3& estimate, const SE3& truth) {
  const SE3 off = estimate.inverse() * truth;
  return {off.translation().norm(), rotation_angle(off) / kDegree};
}

}  // namespace cairn::protocol
