// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/agilex/agilex_chassis.hpp"

#include "drivers/drive/chassis/differential.hpp"

namespace cairn::drive::agilex {

Result<void> Chassis::receive(const CanFrame& frame, Time arrival) {
  const auto message = decode(frame);
  if (!message) return message.error();
  if (!*message) return {};
  if (const auto* state = std::get_if<SystemState>(&**message)) take(*state, arrival);
  if (std::holds_alternative<Odometer>(**message)) odometer_at_ = arrival;
  return {};
}

void Chassis::take(const SystemState& state, Time arrival) {
  // Some models leave the counter at zero: a repeated value tells nothing until it was seen to change.
  const bool changed = !system_ || state.count != system_->count;
  counting_ = counting_ || (system_ && changed);
  if (changed || !counting_) system_at_ = arrival;
  system_ = state;
  if (state.vehicle == Vehicle::kEmergencyStop)
    fault_ = DriveCause::kEmergencyStop;
  else if (was_enabled_ && (state.vehicle != Vehicle::kNormal || state.mode != Mode::kCan))
    fault_ = DriveCause::kMotorFault;
}

Motion Chassis::motion(const Order& order) const {
  if (!order.enable || order.halt) return {};
  const Velocity body = limited({order.v, order.w}, config_.max_speed_m_s, config_.max_yaw_rate_rad_s);
  if (!config_.ackermann) return {.v = body.v, .w = body.w};
  return {.v = body.v, .steering = inner_steering(body, config_.wheelbase_m, config_.wheel_separation_m)};
}

void Chassis::step(Time now, const Order& order, TxQueue& out) {
  if (system_ && now - system_at_ > kStateTimeout) {
    system_.reset();
    if (was_enabled_) fault_ = DriveCause::kFeedbackLost;
  }
  const bool stops = !order.enable || order.halt;
  if (command_due_.due(now) || (stops && !was_stopped_)) {
    out.push(motion_command(motion(order)));
    was_stopped_ = stops;
  }
  if (!order.enable) was_enabled_ = false;
  if (!system_) return;
  const bool can = system_->mode == Mode::kCan;
  if (order.enable && can && system_->vehicle == Vehicle::kNormal) was_enabled_ = true;
  if (order.enable == can || !mode_due_.due(now)) return;
  if (order.reset && system_->error != 0) out.push(clear_errors());
  if (order.enable && config_.ackermann) out.push(brake(false));
  // Remote control and UART are other people's: only CAN is left for standby.
  out.push(control_mode(order.enable ? Mode::kCan : Mode::kStandby));
}

ProtocolStatus Chassis::status() const {
  const bool normal = system_ && system_->vehicle == Vehicle::kNormal;
  return {normal && odometer_at_, normal && system_->mode == Mode::kCan, odometer_at_};
}

}  // namespace cairn::drive::agilex
