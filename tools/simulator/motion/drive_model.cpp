// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/drive_model.hpp"

#include <algorithm>
#include <cmath>

namespace cairn::simulator {

using namespace drive;
using canopen::NmtCommand;
using canopen::NmtState;
using canopen::Object;
using cia402::State;

namespace {

constexpr std::uint32_t kMostEntries = 64;  // of one PDO (CiA 301 §7.4.4)

}  // namespace

DriveModel::DriveModel(const DriveModelConfig& config) : config_(config), random_(config.seed, config.node) {}

std::uint32_t DriveModel::object(Object o) const {
  const auto found = dictionary_.find(key(o));
  return found == dictionary_.end() ? 0 : found->second.value;
}

void DriveModel::put(Object o, std::uint32_t value) { dictionary_.at(key(o)).value = value; }

void DriveModel::power_on(Time now, Frames& out) {
  powered_ = true;
  fault_for_ever_ = false;
  boot(now, out);
}

void DriveModel::boot(Time now, Frames& out) {
  reset_dictionary();
  nmt_ = NmtState::kPreOperational;
  state_ = State::kSwitchOnDisabled;
  controlword_ = 0;
  angle_at_boot_ = angle_;
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
    send_tpdos(out);
  } else if (frame.is(canopen::kHeartbeat + (object(cia402::kConsumerHeartbeat) >> 16U & 0x7FU))) {
    host_heard_ = now;
  } else if (nmt_ == NmtState::kOperational) {
    take_rpdo(frame);
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
  if (state_ == State::kOperationEnabled) state_ = State::kQuickStopActive;
}

void DriveModel::answer(const CanFrame& frame, Frames& out) {
  using Kind = canopen::SdoResponse::Kind;
  const auto request = canopen::decode_sdo_request(frame);
  if (!request || request->kind == canopen::SdoRequest::Kind::kAbort) return;
  canopen::SdoResponse response{Kind::kWritten, request->object, 0, 0};
  refresh();
  const auto found = dictionary_.find(key(request->object));
  std::uint32_t abort = found == dictionary_.end() ? canopen::kAbortNoObject : 0;
  if (abort == 0 && request->kind == canopen::SdoRequest::Kind::kRead) {
    response = {Kind::kValue, request->object, found->second.value, found->second.bytes};
  } else if (abort == 0) {
    abort = write(*request);
  }
  if (abort != 0) response = {Kind::kAbort, request->object, abort, 0};
  out.push_back(canopen::sdo_response(config_.node, response));
}

std::uint32_t DriveModel::write(const canopen::SdoRequest& request) {
  Entry& entry = dictionary_.at(key(request.object));
  if (!entry.writable) return canopen::kAbortReadOnly;
  if (entry.bytes != request.bytes) return 0x06070010;
  const unsigned group = request.object.index & 0xFF00U;
  const bool mapping = group == 0x1600 || group == 0x1A00;
  if (mapping && nmt_ == NmtState::kOperational) return canopen::kAbortState;
  entry.value = request.value;
  if (request.object == cia402::kControlword) obey(static_cast<std::uint16_t>(request.value));
  return 0;
}

void DriveModel::take_rpdo(const CanFrame& frame) {
  for (std::uint16_t n = 0; n < 2; ++n) {
    const std::uint32_t id = object({static_cast<std::uint16_t>(0x1400 + n), 1});
    if ((id & 0x80000000U) != 0 || !frame.is(id & 0x7FFU)) continue;
    const auto mapping = static_cast<std::uint16_t>(0x1600 + n);
    std::size_t at = 0;
    const auto entries = static_cast<std::uint8_t>(std::min(object({mapping, 0}), kMostEntries));
    for (std::uint8_t sub = 1; sub <= entries; ++sub) {
      const std::uint32_t entry = object({mapping, sub});
      const Object target{static_cast<std::uint16_t>(entry >> 16U), static_cast<std::uint8_t>(entry >> 8U & 0xFFU)};
      const std::size_t bytes = (entry & 0xFFU) / 8;
      if (at + bytes > frame.length || dictionary_.count(key(target)) == 0) return;
      put(target, bytes == 4   ? canopen::load_u32(frame, at)
                  : bytes == 2 ? canopen::load_u16(frame, at)
                               : frame.data[at]);
      at += bytes;
      if (target == cia402::kControlword) obey(static_cast<std::uint16_t>(object(target)));
    }
  }
}

void DriveModel::send_tpdos(Frames& out) {
  refresh();
  for (std::uint16_t n = 0; n < 2; ++n) {
    const std::uint32_t id = object({static_cast<std::uint16_t>(0x1800 + n), 1});
    if ((id & 0x80000000U) != 0) continue;
    const auto mapping = static_cast<std::uint16_t>(0x1A00 + n);
    CanFrame frame;
    frame.id = id & 0x7FFU;
    const auto entries = static_cast<std::uint8_t>(std::min(object({mapping, 0}), kMostEntries));
    for (std::uint8_t sub = 1; sub <= entries; ++sub) {
      const std::uint32_t entry = object({mapping, sub});
      const std::size_t bytes = (entry & 0xFFU) / 8;
      if (frame.length + bytes > 8) return;
      const Object source{static_cast<std::uint16_t>(entry >> 16U), static_cast<std::uint8_t>(entry >> 8U & 0xFFU)};
      canopen::store(frame, frame.length, object(source), bytes);
      frame.length = static_cast<std::uint8_t>(frame.length + bytes);
    }
    out.push_back(frame);
  }
}

void DriveModel::fail(std::uint16_t code, Frames& out, bool for_ever) {
  if (!powered_) return;
  state_ = speed_ != 0 && state_ == State::kOperationEnabled ? State::kFaultReactionActive : State::kFault;
  fault_for_ever_ = for_ever;
  put(cia402::kErrorCode, code);
  if (!muted_) out.push_back(canopen::emergency(config_.node, {code, 0x01, {}}));
}

void DriveModel::follow(double angle_rad, double speed_rad_s) {
  followed_ = true;
  angle_ = angle_rad;
  speed_ = speed_rad_s;
}

}  // namespace cairn::simulator
