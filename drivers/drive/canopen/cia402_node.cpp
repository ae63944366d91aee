// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/canopen/cia402_node.hpp"

#include <algorithm>

namespace cairn::drive::cia402 {

using canopen::NmtState;

Node::Node(const Config& config, std::uint8_t id)
    : id_(id),
      bring_up_(config, id),
      heartbeat_timeout_(std::chrono::microseconds(2500) * config.heartbeat_ms),
      sdo_(id) {}

bool Node::enabled() const {
  return phase_ == Phase::kRunning && state_ == State::kOperationEnabled && mode_ == kProfileVelocity;
}

std::optional<Time> Node::feedback() const {
  if (phase_ != Phase::kRunning || !status_at_ || !motion_at_) return std::nullopt;
  return std::min(*status_at_, *motion_at_);
}

Result<void> Node::receive(const CanFrame& frame, Time arrival) {
  if (frame.is(canopen::kHeartbeat + id_)) return receive_heartbeat(frame, arrival);
  if (frame.is(canopen::kEmergency + id_)) return receive_emergency(frame);
  if (frame.is(canopen::kTpdo1 + id_)) return receive_status(frame, arrival);
  if (frame.is(canopen::kTpdo2 + id_)) {
    if (const auto motion = decode_tpdo2(frame); !motion) return motion.error();
    motion_at_ = arrival;
  }
  sdo_.receive(frame);
  return {};
}

Result<void> Node::receive_heartbeat(const CanFrame& frame, Time arrival) {
  const auto state = canopen::decode_heartbeat(frame);
  if (!state) return state.error();
  nmt_ = *state;
  heartbeat_at_ = arrival;
  if (*state == NmtState::kBootUp) booted();
  return {};
}

/// A boot-up that nobody asked for is a fault: the node forgot its configuration, and perhaps moved.
void Node::booted() {
  if (phase_ == Phase::kReset) return;
  if (phase_ == Phase::kAwaitBootUp) {
    boot_seen_ = true;
    return;
  }
  if (phase_ != Phase::kFailed) fault_ = DriveCause::kMotorReset;
  phase_ = Phase::kAwaitBootUp;
  boot_seen_ = true;
}

Result<void> Node::receive_emergency(const CanFrame& frame) {
  const auto message = canopen::decode_emergency(frame);
  if (!message) return message.error();
  error_code_ = message->code;
  if (message->code != 0 && was_enabled_) fault_ = DriveCause::kMotorFault;
  return {};
}

Result<void> Node::receive_status(const CanFrame& frame, Time arrival) {
  const auto status = decode_tpdo1(frame);
  if (!status) return status.error();
  state_ = state_of(status->statusword);
  mode_ = status->mode;
  if (status->error_code != 0) error_code_ = status->error_code;
  status_at_ = arrival;
  if (was_enabled_ && state_ != State::kOperationEnabled) fault_ = DriveCause::kMotorFault;
  return {};
}

void Node::enter(Phase phase, Time now, Duration timeout) {
  phase_ = phase;
  deadline_ = now + timeout;
}

void Node::fail(Time now, std::string_view why) {
  failure_ = why;
  enter(Phase::kFailed, now, kRetry);
}

void Node::step(Time now, TxQueue& out) {
  switch (phase_) {
    case Phase::kReset:
      out.push(canopen::nmt(canopen::NmtCommand::kResetCommunication, id_));
      boot_seen_ = false;
      return enter(Phase::kAwaitBootUp, now, kBootTimeout);
    case Phase::kAwaitBootUp:
      if (boot_seen_) {
        step_ = 0;
        step_begun_ = reading_back_ = was_enabled_ = false;
        state_ = State::kUnknown;
        status_at_ = motion_at_ = std::nullopt;
        return enter(Phase::kConfigure, now, {});
      }
      if (now >= deadline_)
        fail(now, "no boot-up message: is the node powered, its identifier and the bit rate right?");
      return;
    case Phase::kConfigure:
      return configure(now, out);
    case Phase::kAwaitOperational:
      if (nmt_ == NmtState::kOperational) {
        was_running_ = true;
        return enter(Phase::kRunning, now, {});
      }
      if (now >= deadline_) fail(now, "the node does not become operational");
      return;
    case Phase::kRunning:
      return supervise(now);
    case Phase::kFailed:
      if (now >= deadline_) phase_ = Phase::kReset;
      return;
  }
}

void Node::configure(Time now, TxQueue& out) {
  if (step_begun_ && sdo_.state() != canopen::SdoClient::State::kBusy) {
    step_begun_ = false;
    failed_object_ = bring_up_.steps()[step_].object;
    if (const auto why = finish_step(); !why.empty()) return fail(now, why);
  }
  if (step_ == bring_up_.steps().size()) {
    out.push(canopen::nmt(canopen::NmtCommand::kStart, id_));
    failure_ = {};
    return enter(Phase::kAwaitOperational, now, kStartTimeout);
  }
  if (!step_begun_) begin_step();
  sdo_.step(now, out);
}

void Node::begin_step() {
  const Step& step = bring_up_.steps()[step_];
  if (step.kind == Step::Kind::kCheck || reading_back_)
    sdo_.read(step.object);
  else
    sdo_.write(step.object, step.value, step.bytes);
  step_begun_ = true;
}

std::string_view Node::finish_step() {
  using Client = canopen::SdoClient::State;
  const Step& step = bring_up_.steps()[step_];
  if (sdo_.state() == Client::kTimedOut) return "no answer to an SDO request";
  if (sdo_.state() == Client::kAborted && step.kind != Step::Kind::kTry)
    return canopen::abort_text(sdo_.response().value);
  const bool reads = step.kind == Step::Kind::kCheck || reading_back_;
  if (reads && (sdo_.response().value & step.mask) != step.value)
    return "an object has another value than it must have";
  reading_back_ = step.kind == Step::Kind::kWriteCheck && !reading_back_;
  if (!reading_back_) ++step_;
  return {};
}

void Node::supervise(Time now) {
  const bool silent = now - heartbeat_at_ > heartbeat_timeout_;
  if (!silent && nmt_ == NmtState::kOperational) return;
  fault_ = silent ? DriveCause::kFeedbackLost : DriveCause::kMotorFault;
  fail(now, silent ? "no heartbeat" : "the node is not operational any more");
}

std::uint16_t Node::controlword(const Order& order) {
  if (!order.enable) return towards_rest(state_);
  if (state_ == State::kFault && order.reset) return sent_.controlword == kFaultReset ? kDisableVoltage : kFaultReset;
  if (state_ == State::kSwitchedOn && mode_ != kProfileVelocity) return kSwitchOn;
  const std::uint16_t word = towards_operation(state_);
  return state_ == State::kOperationEnabled && order.halt ? word | kHalt : word;
}

void Node::order(Time now, const Order& order, std::int32_t target, TxQueue& out) {
  if (!order.enable) was_enabled_ = false;
  if (!was_running_) return;
  if (order.enable && enabled()) was_enabled_ = true;
  const bool stops = !order.enable || order.halt;
  const bool urgent =
      stops && (sent_.target_velocity != 0 || (!order.enable && sent_.controlword != towards_rest(state_)));
  if (!order_due_.due(now) && !urgent) return;
  // A node that is not heard may still hear, and run: it is told to stop all the time.
  sent_.controlword = phase_ == Phase::kRunning ? controlword(order) : kQuickStop;
  sent_.target_velocity = enabled() && !stops ? target : 0;
  out.push(rpdo1(id_, sent_));
}

}  // namespace cairn::drive::cia402
