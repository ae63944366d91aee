// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/drive_model.hpp"

#include <cmath>

#include "tools/simulator/motor/pdo_mapping.hpp"

namespace cairn::simulator {

using namespace drive;
using canopen::NmtCommand;
using canopen::NmtState;
using canopen::Object;

DriveModel::DriveModel(const DriveModelConfig& config) : config_(config), random_(config.seed, config.node) {}

void DriveModel::power_on(Time now, Frames& out) {
  powered_ = true;
  power_.power_up();
  boot(now, out);
}

void DriveModel::boot(Time now, Frames& out) {
  objects_ = {config_.vendor, config_.product, static_cast<std::uint32_t>(10 * config_.velocity_units_per_rad_s)};
  objects_.put(cia402::kProducerHeartbeat, static_cast<std::uint32_t>(config_.heartbeat_ms));
  nmt_ = NmtState::kPreOperational;
  power_.boot();
  angle_at_boot_ = wheel_.angle();
  host_heard_.reset();
  heartbeat_at_ = now;
  if (!muted_) out.push_back(canopen::heartbeat(config_.node, NmtState::kBootUp));
}

void DriveModel::receive(const CanFrame& frame, Time now, Frames& out) {
  if (!powered_ || frame.error() || muted_) return;
  step(now, out);
  if (frame.is(canopen::kNmt) && frame.length == 2) {
    if (frame.data[1] == 0 || frame.data[1] == config_.node) command(static_cast<NmtCommand>(frame.data[0]), now, out);
  } else if (frame.is(canopen::kSdoRequest + config_.node)) {
    answer(frame, out);
  } else if (frame.is(canopen::kSync) && nmt_ == NmtState::kOperational) {
    refresh();
    pack_tpdos(objects_, out);
  } else if (frame.is(canopen::kHeartbeat + (object(cia402::kConsumerHeartbeat) >> 16U & 0x7FU))) {
    host_heard_ = now;
  } else if (nmt_ == NmtState::kOperational) {
    unpack_rpdos(frame, objects_, [this](Object written) { obey_if_written(written); });
  }
}

void DriveModel::command(NmtCommand command, Time now, Frames& out) {
  switch (command) {
    case NmtCommand::kStart:
      nmt_ = NmtState::kOperational;
      return;
    case NmtCommand::kStop:
      nmt_ = NmtState::kStopped;
      break;
    case NmtCommand::kPreOperational:
      nmt_ = NmtState::kPreOperational;
      break;
    case NmtCommand::kResetNode:
    case NmtCommand::kResetCommunication:
      return boot(now, out);
  }
  power_.quick_stop();
}

void DriveModel::answer(const CanFrame& frame, Frames& out) {
  const auto request = canopen::decode_sdo_request(frame);
  if (!request || request->kind == canopen::SdoRequest::Kind::kAbort) return;
  refresh();
  const auto response = objects_.answer(*request, nmt_ == NmtState::kOperational);
  if (response.kind == canopen::SdoResponse::Kind::kWritten) obey_if_written(request->object);
  out.push_back(canopen::sdo_response(config_.node, response));
}

void DriveModel::obey_if_written(Object object) {
  if (object != cia402::kControlword) return;
  if (power_.obey(static_cast<std::uint16_t>(objects_.value(object)))) objects_.put(cia402::kErrorCode, 0);
}

void DriveModel::fail(std::uint16_t code, Frames& out, bool for_ever) {
  if (!powered_) return;
  power_.fail(wheel_.speed() != 0, for_ever);
  objects_.put(cia402::kErrorCode, code);
  if (!muted_) out.push_back(canopen::emergency(config_.node, {code, 0x01, {}}));
}

/// What the device itself says of its state.
void DriveModel::refresh() {
  const auto rounded = [](double value) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(value)));
  };
  objects_.put(cia402::kStatusword, power_.statusword());
  objects_.put(cia402::kModeDisplay, object(cia402::kMode));
  double counts = (wheel_.angle() - angle_at_boot_) * config_.position_counts_per_rad;
  if (config_.encoder_noise_counts > 0) counts += config_.encoder_noise_counts * random_.normal_pair().first;
  objects_.put(cia402::kPosition, rounded(counts));
  objects_.put(cia402::kVelocity, rounded(wheel_.speed() * config_.velocity_units_per_rad_s));
}

double DriveModel::ramp(Object o) const { return object(o) / config_.velocity_units_per_rad_s; }

void DriveModel::move(double dt) {
  if (wheel_.followed()) return;
  const bool runs = powered_ && power_.enabled() && object(cia402::kMode) == 3;
  const auto units = static_cast<std::int32_t>(object(cia402::kTargetVelocity));
  const double goal = runs && !power_.halted() ? units / config_.velocity_units_per_rad_s : 0;
  double rate = config_.coasting_rad_s2;
  if (runs) rate = ramp(std::abs(goal) > std::abs(wheel_.speed()) ? cia402::kAcceleration : cia402::kDeceleration);
  if (powered_ && power_.braking()) rate = ramp(cia402::kQuickStopDeceleration);
  wheel_.move(goal, rate, dt);
  if (wheel_.speed() == 0) power_.at_rest();
}

void DriveModel::watch_host(Time now, Frames& out) {
  const Duration limit = std::chrono::milliseconds(object(cia402::kConsumerHeartbeat) & 0xFFFFU);
  if (!host_heard_ || limit == Duration::zero() || now - *host_heard_ <= limit) return;
  host_heard_.reset();
  if (object(cia402::kAbortConnection) == cia402::kReactQuickStop) power_.quick_stop();
  nmt_ = NmtState::kPreOperational;  // 1029:1 = 0
  if (!muted_) out.push_back(canopen::emergency(config_.node, {0x8130, 0x10, {}}));
}

void DriveModel::step(Time now, Frames& out) {
  const Duration dt = stepped_ ? now - *stepped_ : Duration::zero();
  stepped_ = now;
  if (dt > Duration::zero()) move(to_seconds(dt));
  if (!powered_) return;
  watch_host(now, out);
  const Duration period = std::chrono::milliseconds(object(cia402::kProducerHeartbeat));
  if (period == Duration::zero() || now - heartbeat_at_ < period) return;
  heartbeat_at_ = now;
  if (!muted_) out.push_back(canopen::heartbeat(config_.node, nmt_));
}

}  // namespace cairn::simulator
