// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/messages/wheels_message.hpp"

#include <algorithm>

namespace cairn::app {
namespace {

using clients::WheelPlace;

WheelPlace place_of(const drive::WheelMotion& wheel, bool four) {
  if (!four) return wheel.left ? WheelPlace::kLeft : WheelPlace::kRight;
  if (wheel.rear) return wheel.left ? WheelPlace::kRearLeft : WheelPlace::kRearRight;
  return wheel.left ? WheelPlace::kFrontLeft : WheelPlace::kFrontRight;
}

}  // namespace

clients::WheelsMessage message_of(const WheelNews& news, double radius_m) {
  clients::WheelsMessage message{.stamp = news.state.stamp,
                                 .v = news.state.v,
                                 .w = news.state.w,
                                 .covariance = news.state.twist_covariance,
                                 .slipping = news.state.slipping,
                                 .radius_m = radius_m};
  const auto wheels = news.wheels.all();
  const bool four = std::ranges::any_of(wheels, &drive::WheelMotion::rear);
  for (const drive::WheelMotion& wheel : wheels)
    message.wheels.push_back({place_of(wheel, four), wheel.travel_m, wheel.speed_m_s});
  return message;
}

}  // namespace cairn::app
