// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/wheels.hpp"

#include <algorithm>
#include <array>

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {
namespace {

constexpr auto kLastPlace = static_cast<std::uint32_t>(WheelPlace::kRearRight);

WheelsMessage::Wheel read_wheel(FieldReader& in) {
  WheelsMessage::Wheel wheel;
  wheel.place = static_cast<WheelPlace>(in.up_to(kLastPlace));
  in.require(in.number<std::uint32_t>() == 0);
  wheel.travel_m = in.real();
  wheel.speed_m_s = in.real();
  return wheel;
}

}  // namespace

std::string_view to_string(WheelPlace place) {
  constexpr std::array<std::string_view, 6> kNames{"left",        "right",     "front_left",
                                                   "front_right", "rear_left", "rear_right"};
  const auto i = static_cast<std::size_t>(place);
  return i < kNames.size() ? kNames[i] : "unknown";
}

void encode(const WheelsMessage& message, std::vector<std::byte>& out) {
  const std::size_t count = std::min(message.wheels.size(), WheelsMessage::kMost);
  append_time(out, message.stamp);
  append_le(out, std::uint32_t{message.slipping});
  append_le(out, static_cast<std::uint32_t>(count));
  append_le(out, message.v);
  append_le(out, message.w);
  append_le(out, message.covariance(0, 0));
  append_le(out, message.covariance(0, 1));
  append_le(out, message.covariance(1, 1));
  append_le(out, message.radius_m);
  for (std::size_t i = 0; i < count; ++i) {
    append_le(out, static_cast<std::uint32_t>(message.wheels[i].place));
    append_le(out, std::uint32_t{0});
    append_le(out, message.wheels[i].travel_m);
    append_le(out, message.wheels[i].speed_m_s);
  }
}

Result<WheelsMessage> decode_wheels(std::span<const std::byte> body) {
  FieldReader in(body);
  WheelsMessage message;
  message.stamp = in.time();
  message.slipping = in.up_to(std::uint32_t{1}) != 0;
  const auto count = in.up_to(static_cast<std::uint32_t>(WheelsMessage::kMost));
  message.v = in.real();
  message.w = in.real();
  message.covariance(0, 0) = in.real();
  message.covariance(0, 1) = message.covariance(1, 0) = in.real();
  message.covariance(1, 1) = in.real();
  message.radius_m = in.real();
  in.require(message.covariance(0, 0) >= 0 && message.covariance(1, 1) >= 0 && message.radius_m >= 0);
  for (std::uint32_t i = 0; i < count && in.good(); ++i) message.wheels.push_back(read_wheel(in));
  if (!in.complete()) return in.error("not a state of wheels");
  return message;
}

}  // namespace cairn::clients
