// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/own_place.hpp"

#include <cmath>

namespace cairn::peers {
namespace {

constexpr double kMost = 1e6;  // m, rad: decode_datagram() refuses more

}  // namespace

std::optional<Hello::Place> place_of(const UncertainPose& T_odom_base) {
  const Eigen::Vector3d at = T_odom_base.mean.translation();
  if (!at.allFinite() || at.cwiseAbs().maxCoeff() > kMost) return std::nullopt;
  const Eigen::Vector3d x_axis = T_odom_base.mean.rotation().col(0);
  const Vector6 sigma = T_odom_base.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  return Hello::Place{.position_m = {at.x(), at.y(), at.z()},
                      .yaw_rad = std::atan2(x_axis.y(), x_axis.x()),
                      .sigma_m = std::fmin(kMost, sigma.head<3>().maxCoeff()),
                      .sigma_rad = std::fmin(kMost, sigma.tail<3>().maxCoeff())};
}

}  // namespace cairn::peers
