// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/hello.hpp"

#include <algorithm>

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {

void encode(const HelloMessage& message, std::vector<std::byte>& out) {
  append_le(out, message.session);
  append_le(out, message.robot_id);
  append_le(out, static_cast<std::int64_t>(message.realtime_offset.count()));
  append_le(out, message.resolution_m);
  append_text(out, message.robot, HelloMessage::kMaxText);
  const std::size_t sensors = std::min(message.sensors.size(), HelloMessage::kMaxSensors);
  append_le(out, static_cast<std::uint8_t>(sensors));
  for (std::size_t i = 0; i < sensors; ++i) {
    append_text(out, message.sensors[i].name, HelloMessage::kMaxText);
    append_pose(out, message.sensors[i].T_base_sensor);
  }
}

Result<HelloMessage> decode_hello(std::span<const std::byte> body) {
  FieldReader in(body);
  HelloMessage message;
  message.session = in.number<std::uint64_t>();
  message.robot_id = in.number<std::uint64_t>();
  message.realtime_offset = Duration{in.number<std::int64_t>()};
  message.resolution_m = in.real();
  in.require(message.resolution_m >= 1e-3 && message.resolution_m <= 1e3);
  message.robot = in.text(HelloMessage::kMaxText);
  const auto sensors = in.up_to(static_cast<std::uint8_t>(HelloMessage::kMaxSensors));
  for (unsigned i = 0; i < sensors && in.good(); ++i) {
    auto& sensor = message.sensors.emplace_back();
    sensor.name = in.text(HelloMessage::kMaxText);
    sensor.T_base_sensor = in.pose();
  }
  if (!in.complete()) return in.error("not the greeting of a core");
  return message;
}

}  // namespace cairn::clients
