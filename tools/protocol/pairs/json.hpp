// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "hal/se3.hpp"

namespace cairn::protocol {

using Json = nlohmann::ordered_json;

/// x y z qx qy qz qw.
[[nodiscard]] inline Json pose_to_json(const SE3& T) {
  const Eigen::Vector3d& t = T.translation();
  const Eigen::Quaterniond& q = T.quaternion();
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}
/// Throws nlohmann::json::exception where there are no seven numbers.
[[nodiscard]] inline SE3 pose_from_json(const Json& json) {
  const auto at = [&](std::size_t i) { return json.at(i).get<double>(); };
  return {Eigen::Quaterniond(at(6), at(3), at(4), at(5)), Eigen::Vector3d(at(0), at(1), at(2))};
}

}  // namespace cairn::protocol
