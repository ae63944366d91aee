// SPDX-License-Identifier: Apache-2.0
// The motor of a DriveModel: object dictionary, power state machine, ramps, watchdog.
#include <algorithm>
#include <cmath>

#include "tools/simulator/motion/drive_model.hpp"

namespace cairn::simulator {

using namespace drive;
using canopen::NmtState;
using canopen::Object;
using cia402::State;

void DriveModel::reset_dictionary() {
  dictionary_.clear();
  const auto fixed = [&](Object o, std::uint32_t value, std::uint8_t bytes) {
    dictionary_[key(o)] = {value, bytes, false};
  };
  const auto open = [&](Object o, std::uint32_t value, std::uint8_t bytes) {
    dictionary_[key(o)] = {value, bytes, true};
  };
  fixed(cia402::kDeviceType, 0x00020192, 4);
  fixed(cia402::kVendor, config_.vendor, 4);
  fixed(cia402::kProduct, config_.product, 4);
  open(cia402::kConsumerHeartbeat, 0, 4);
  open(cia402::kProducerHeartbeat, 0, 2);
  open(cia402::kAbortConnection, 1, 2);
  fixed(cia402::kErrorCode, 0, 2);
  open(cia402::kControlword, 0, 2);
  fixed(cia402::kStatusword, 0, 2);
  open(cia402::kQuickStopOption, 2, 2);
  open(cia402::kMode, 0, 1);
  fixed(cia402::kModeDisplay, 0, 1);
  fixed(cia402::kPosition, 0, 4);
  fixed(cia402::kVelocity, 0, 4);
  const auto ramp = static_cast<std::uint32_t>(10 * config_.velocity_units_per_rad_s);
  open(cia402::kAcceleration, ramp, 4);
  open(cia402::kDeceleration, ramp, 4);
  open(cia402::kQuickStopDeceleration, 3 * ramp, 4);
  open(cia402::kTargetVelocity, 0, 4);
  define_pdos();
}

void DriveModel::define_pdos() {
  for (std::uint16_t n = 0; n < 2; ++n) {
    for (const unsigned base : {0x1400U, 0x1800U}) {
      const auto communication = static_cast<std::uint16_t>(base + n),
                 mapping = static_cast<std::uint16_t>(base + 0x200U + n);
      dictionary_[key({communication, 1})] = {0x80000000U, 4, true};
      dictionary_[key({communication, 2})] = {255, 1, true};
      dictionary_[key({mapping, 0})] = {0, 1, true};
      for (std::uint8_t sub = 1; sub <= 8; ++sub) dictionary_[key({mapping, sub})] = {0, 4, true};
    }
  }
}

std::uint16_t DriveModel::statusword() const {
  switch (state_) {
    case State::kSwitchOnDisabled:
      return 0x0240;
    case State::kReadyToSwitchOn:
      return 0x0231;
    case State::kSwitchedOn:
      return 0x0233;
    case State::kOperationEnabled:
      return 0x0237;
    case State::kQuickStopActive:
      return 0x0217;
    case State::kFaultReactionActive:
      return 0x021F;
    case State::kFault:
      return 0x0218;
    default:
      return 0;
  }
}

void DriveModel::refresh() {
  put(cia402::kStatusword, statusword());
  put(cia402::kModeDisplay, object(cia402::kMode));
  double counts = (angle_ - angle_at_boot_) * config_.position_counts_per_rad;
  if (config_.encoder_noise_counts > 0) counts += config_.encoder_noise_counts * random_.normal_pair().first;
  put(cia402::kPosition, static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(counts))));
  put(cia402::kVelocity,
      static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(speed_ * config_.velocity_units_per_rad_s))));
}

/// The transitions of CiA 402-2, figure 10, by controlword.
void DriveModel::obey(std::uint16_t word) {
  const bool reset = (word & cia402::kFaultReset) != 0 && (controlword_ & cia402::kFaultReset) == 0;
  controlword_ = word;
  if (state_ == State::kFault) {
    if (!reset || fault_for_ever_) return;
    put(cia402::kErrorCode, 0);
    state_ = State::kSwitchOnDisabled;
    return;
  }
  if (state_ == State::kFaultReactionActive) return;
  const unsigned command = word & 0x0FU;
  if ((command & 0x02U) == 0) {
    state_ = State::kSwitchOnDisabled;
  } else if ((command & 0x04U) == 0) {
    state_ = state_ == State::kOperationEnabled || state_ == State::kQuickStopActive ? State::kQuickStopActive
                                                                                     : State::kSwitchOnDisabled;
  } else if (state_ == State::kQuickStopActive) {
    return;
  } else if ((command & 0x07U) == 0x06) {
    state_ = State::kReadyToSwitchOn;
  } else if (command == 0x07 && state_ != State::kSwitchOnDisabled) {
    state_ = State::kSwitchedOn;
  } else if (command == 0x0F && (state_ == State::kSwitchedOn || state_ == State::kOperationEnabled)) {
    state_ = State::kOperationEnabled;
  }
}

double DriveModel::ramp(Object o) const { return object(o) / config_.velocity_units_per_rad_s; }

void DriveModel::move(double dt) {
  if (followed_) return;
  const bool runs = powered_ && state_ == State::kOperationEnabled && object(cia402::kMode) == 3;
  const bool halted = (controlword_ & cia402::kHalt) != 0;
  const auto units = static_cast<std::int32_t>(object(cia402::kTargetVelocity));
  const double goal = runs && !halted ? units / config_.velocity_units_per_rad_s : 0;
  double rate = config_.coasting_rad_s2;
  if (runs) rate = ramp(std::abs(goal) > std::abs(speed_) ? cia402::kAcceleration : cia402::kDeceleration);
  if (powered_ && (state_ == State::kQuickStopActive || state_ == State::kFaultReactionActive))
    rate = ramp(cia402::kQuickStopDeceleration);
  const double before = speed_;
  speed_ += std::clamp(goal - speed_, -rate * dt, rate * dt);
  angle_ += (before + speed_) / 2 * dt;
  if (speed_ != 0) return;
  if (state_ == State::kQuickStopActive) state_ = State::kSwitchOnDisabled;
  if (state_ == State::kFaultReactionActive) state_ = State::kFault;
}

void DriveModel::watch_host(Time now, Frames& out) {
  const Duration limit = std::chrono::milliseconds(object(cia402::kConsumerHeartbeat) & 0xFFFFU);
  if (!host_heard_ || limit == Duration::zero() || now - *host_heard_ <= limit) return;
  host_heard_.reset();
  if (object(cia402::kAbortConnection) == cia402::kReactQuickStop && state_ == State::kOperationEnabled)
    state_ = State::kQuickStopActive;
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
