// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/canopen/cia402_master.hpp"

#include <algorithm>

#include "drivers/drive/chassis/differential.hpp"

namespace cairn::drive::cia402 {

Master::Master(const Config& config)
    : config_(config), heartbeat_due_(std::chrono::microseconds(250) * config.host_heartbeat_ms) {
  const auto add = [&](int id, bool left) {
    if (id == 0) return;
    nodes_.emplace_back(config, static_cast<std::uint8_t>(id));
    left_.push_back(left);
    reversed_.push_back(left ? config.left_reversed : config.right_reversed);
  };
  add(config.left_node, true);
  add(config.right_node, false);
  add(config.rear_left_node, true);
  add(config.rear_right_node, false);
}

Result<void> Master::receive(const CanFrame& frame, Time arrival) {
  Result<void> result;
  for (Node& node : nodes_)
    if (auto taken = node.receive(frame, arrival); !taken) result = taken;
  return result;
}

void Master::step(Time now, const Order& order, TxQueue& out) {
  const Velocity body = limited({order.v, order.w}, config_.max_speed_m_s, config_.max_yaw_rate_rad_s);
  const WheelSpeeds wheels = wheel_speeds(body, config_.wheel_separation_m);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const double rim = left_[i] ? wheels.left : wheels.right;
    nodes_[i].order(now, order, velocity_units(config_, reversed_[i] ? -rim : rim), out);
  }
  if (heartbeat_due_.due(now))
    out.push(canopen::heartbeat(static_cast<std::uint8_t>(config_.host_node), canopen::NmtState::kOperational));
  if (sync_due_.due(now)) out.push(canopen::sync());
  for (Node& node : nodes_) node.step(now, out);
}

ProtocolStatus Master::status() const {
  ProtocolStatus status{true, true, Time::max()};
  for (const Node& node : nodes_) {
    const auto feedback = node.feedback();
    status.ready = status.ready && feedback.has_value();
    status.enabled = status.enabled && node.enabled();
    status.feedback = feedback && status.feedback ? std::optional(std::min(*feedback, *status.feedback)) : std::nullopt;
  }
  return status;
}

DriveCause Master::take_fault() {
  DriveCause fault = DriveCause::kNone;
  for (Node& node : nodes_) fault = std::max(fault, node.take_fault());
  return fault;
}

}  // namespace cairn::drive::cia402
