// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can_drive.hpp"

#include <algorithm>

#include "drivers/drive/agilex/agilex_chassis.hpp"
#include "drivers/drive/canopen/cia402_master.hpp"

namespace cairn::drive {

Result<std::unique_ptr<CanDrive>> CanDrive::create(const Config& config, CanLink& link, Tap tap) {
  if (auto sound = check(config); !sound) return sound.error();
  return std::unique_ptr<CanDrive>(new CanDrive(config, link, std::move(tap)));
}

CanDrive::CanDrive(const Config& config, CanLink& link, Tap tap) : config_(config), link_(link), tap_(std::move(tap)) {
  if (config.protocol == "agilex")
    protocol_ = std::make_unique<agilex::Chassis>(config);
  else
    protocol_ = std::make_unique<cia402::Master>(config);
  packet_.bytes.reserve(kFdBytes);  // a tick must not allocate, the first one neither
  if (auto decoder = WheelDecoder::create(config)) decoder_ = std::move(*decoder);
}

Guard::Inputs CanDrive::inputs() const {
  return {protocol_->status(), monitor_.state(), monitor_.queue_full(), fault_};
}

Result<void> CanDrive::command(const DriveCommand& command, Time now) {
  auto taken = guard_.command(command, now);
  if (!taken) ++counters_.discarded_commands;
  return taken;
}

Result<std::uint32_t> CanDrive::arm(Time now) {
  if (const std::string missing = enable_fault(config_); !missing.empty())
    return Error{Errc::kInvalidConfig, "cannot arm: these keys of the drive are not configured", {}, {}, missing};
  if (monitor_.state() == LinkMonitor::State::kFailed) monitor_.retry(now);
  auto epoch = guard_.arm(now, inputs());
  if (epoch) fault_ = DriveCause::kNone;
  return epoch;
}

/// Does not wait for the next tick: the zero leaves at once.
void CanDrive::stop(DriveCause cause, Time now) {
  guard_.stop(cause);
  run_protocol(now);
  transmit();
}

Result<const DriveState*> CanDrive::tick(Time now) {
  auto state = receive();
  run_protocol(now);
  if (monitor_.step(now)) {
    ++counters_.restarts;
    if (auto restarted = link_.restart(); !restarted && state) state = restarted.error();
  }
  transmit();
  return state;
}

void CanDrive::run_protocol(Time now) {
  fault_ = std::max(fault_, protocol_->take_fault());
  const Order order = guard_.decide(now, inputs());
  // A fault concerns the arming during which it came; what lasts is reported again.
  if (!guard_.armed()) fault_ = DriveCause::kNone;
  protocol_->step(now, order, queue_);
}

Result<const DriveState*> CanDrive::receive() {
  Result<const DriveState*> newest = nullptr;
  for (int i = 0; i < kMaxReceived; ++i) {
    const auto poll = link_.next(packet_, Duration::zero());
    if (!poll) {
      monitor_.sent(SendResult::kDown);
      return poll.error();
    }
    if (*poll != Poll::kPacket) break;
    ++counters_.received;
    if (tap_) tap_(packet_);
    const auto state = take(packet_);
    if (!state)
      ++counters_.rejected;
    else if (*state != nullptr)
      newest = *state;
  }
  return newest;
}

Result<const DriveState*> CanDrive::take(const Packet& packet) {
  const auto frame = decode_frame(packet.payload());
  if (!frame) return frame.error();
  monitor_.receive(*frame, packet.arrival);
  // The next frame may tell of recovery already: the stop must not miss what was between two ticks.
  fault_ = std::max(fault_, Guard::link_cause(monitor_.state()));
  if (frame->error()) return nullptr;
  if (auto taken = protocol_->receive(*frame, packet.arrival); !taken) return taken.error();
  return decoder_ ? decoder_->decode(*frame, packet.arrival) : Result<const DriveState*>(nullptr);
}

/// Until the interface takes no more. What is left waits for the next tick, where newer frames take its place.
void CanDrive::transmit() {
  std::size_t sent = 0;
  for (const CanFrame& frame : queue_.frames()) {
    const SendResult result = link_.send(frame);
    monitor_.sent(result);
    if (result != SendResult::kSent) {
      ++counters_.send_failures;
      break;
    }
    ++sent;
  }
  counters_.sent += sent;
  queue_.drop_front(sent);
}

}  // namespace cairn::drive
