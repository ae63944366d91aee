// SPDX-License-Identifier: Apache-2.0
#include "tools/ros/messages/wheels.hpp"

#include <cstddef>
#include <string>

namespace cairn::ros {

JointState joint_state_of(const clients::WheelsMessage& wheels, const Frames& frames, Duration utc_offset,
                          Arena& arena) {
  JointState message{};
  message.header = header_of(wheels.stamp, utc_offset, "", arena);
  const std::size_t count = wheels.wheels.size();
  const auto names = arena.sequence(message.name, count);
  const auto angles = arena.sequence(message.position, count), rates = arena.sequence(message.velocity, count);
  (void)arena.sequence(message.effort, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& wheel = wheels.wheels[i];
    names[i] = arena.text(frames.prefix + std::string(to_string(wheel.place)) + "_wheel_joint");
    angles[i] = wheel.travel_m / wheels.radius_m;
    rates[i] = wheel.speed_m_s / wheels.radius_m;
  }
  return message;
}

}  // namespace cairn::ros
