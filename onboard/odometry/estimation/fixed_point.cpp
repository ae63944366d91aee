// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/fixed_point.hpp"

#include <algorithm>

namespace cairn::odometry {
namespace {

// Of the way back to the last g. All of it would stay where the last step was.
constexpr double kFarthestBack = 0.9;

/// Where between `now` and `last` the change would vanish, as a share of the way back.
double way_back(const Eigen::Vector3d& now, const Eigen::Vector3d& last) {
  const Eigen::Vector3d difference = now - last;
  const double squared = difference.squaredNorm();
  return squared > 0 ? std::clamp(now.dot(difference) / squared, 0.0, kFarthestBack) : 0.0;
}

}  // namespace

Vector6 FixedPoint::next(const Vector6& x, const Vector6& g) {
  const Vector6 change = g - x;
  Vector6 next = g;
  if (began_) {
    for (const int part : {0, 3}) {
      const double share = way_back(change.segment<3>(part), change_.segment<3>(part));
      next.segment<3>(part) += share * (g_ - g).segment<3>(part);
    }
  }
  began_ = true;
  g_ = g;
  change_ = change;
  return next;
}

}  // namespace cairn::odometry
