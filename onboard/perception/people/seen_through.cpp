// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/people/seen_through.hpp"

#include <cmath>

namespace cairn::people {
namespace {

constexpr float kHalfWidth = 0.2F, kBehind = 0.5F;      // m
constexpr float kLowestRay = 0.2F, kHighestRay = 1.7F;  // m above the ground
constexpr int kFewestRays = 4;
constexpr int kTimes = 3;  // as many as end in the body

}  // namespace

bool seen_through(const Eigen::Vector2d& position, float ground, std::span<const Eigen::Vector3f> points_odom,
                  const Eigen::Vector3f& sensor_odom) {
  const Eigen::Vector2f to = position.cast<float>() - sensor_odom.head<2>();
  const float distance = to.norm();
  if (!(distance > kBehind)) return false;
  const Eigen::Vector2f along = to / distance;
  int through = 0, within = 0;
  for (const Eigen::Vector3f& p : points_odom) {
    const Eigen::Vector2f ray = p.head<2>() - sensor_odom.head<2>();
    const float forward = ray.dot(along);
    if (!(forward >= distance - kBehind)) continue;
    const float share = distance / forward;  // of the ray, up to the body's place
    const float aside = (along.x() * ray.y() - along.y() * ray.x()) * share;
    const float height = sensor_odom.z() + share * (p.z() - sensor_odom.z()) - ground;
    if (std::abs(aside) > kHalfWidth || height < kLowestRay || height > kHighestRay) continue;
    if (forward > distance + kBehind)
      ++through;
    else
      ++within;
  }
  return through >= kFewestRays && through >= kTimes * within;
}

}  // namespace cairn::people
