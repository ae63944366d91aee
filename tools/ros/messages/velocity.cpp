// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/velocity.hpp"

#include <cmath>

#include "tools/ros/messages/header.hpp"

namespace cairn::ros {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kTake:
      return "taken";
    case Verdict::kNotFinite:
      return "not a finite velocity";
    case Verdict::kNotPossible:
      return "a motion that wheels cannot make: only linear.x and angular.z may differ from 0";
    case Verdict::kTooOld:
      return "its stamp differs from this machine's clock by half a second or more";
  }
  return "";
}

Verdict judge(const Twist& twist, Velocity& velocity) {
  const auto& [linear, angular] = twist;
  for (const double value : {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z})
    if (!std::isfinite(value)) return Verdict::kNotFinite;
  if (linear.y != 0 || linear.z != 0 || angular.x != 0 || angular.y != 0) return Verdict::kNotPossible;
  velocity = {.v = linear.x, .w = angular.z};
  return Verdict::kTake;
}

Verdict judge(const TwistStamped& twist, Duration utc, Velocity& velocity) {
  const Verdict age = judge_age(utc_of(twist.header.stamp), utc);
  return age == Verdict::kTake ? judge(twist.twist, velocity) : age;
}

Verdict judge_age(Duration written, Duration utc) {
  const Duration age = utc - written;
  return age < kMostAge && age > -kMostAge ? Verdict::kTake : Verdict::kTooOld;
}

}  // namespace cairn::ros
