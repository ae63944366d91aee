// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/guard.hpp"

#include <cmath>
#include <string>

namespace cairn::drive {

Result<void> Guard::command(const DriveCommand& command, Time now) {
  if (!armed_ || command.epoch != status_.epoch)
    return Error{Errc::kLimit, "the command is of another epoch, or the drive is stopped", {}, {}, {}};
  bad_command_ = !std::isfinite(command.v) || !std::isfinite(command.w);
  if (bad_command_) {
    command_.reset();
    return Error{Errc::kMalformed, "the command is not finite", {}, {}, {}};
  }
  command_ = command;
  command_at_ = now;
  return {};
}

DriveCause Guard::link_cause(LinkMonitor::State link) {
  using Link = LinkMonitor::State;
  if (link == Link::kDown) return DriveCause::kLinkDown;
  if (link == Link::kBusOff || link == Link::kFailed) return DriveCause::kBusOff;
  return link == Link::kErrorPassive ? DriveCause::kErrorPassive : DriveCause::kNone;
}

DriveCause Guard::stop_cause(Time now, const Inputs& in) {
  if (in.fault != DriveCause::kNone) return in.fault;
  if (const DriveCause link = link_cause(in.link); link != DriveCause::kNone) return link;
  if (!in.protocol.feedback || now - *in.protocol.feedback > kFeedbackLost) return DriveCause::kFeedbackLost;
  return DriveCause::kNone;
}

Result<std::uint32_t> Guard::arm(Time now, const Inputs& in) {
  const auto refuse = [](std::string_view why) {
    return Error{Errc::kLinkDown, "cannot arm", {}, {}, std::string(why)};
  };
  // A fault from before is what arming acknowledges; everything that still lasts is in the way.
  Inputs lasting = in;
  if (in.fault != DriveCause::kEmergencyStop) lasting.fault = DriveCause::kNone;
  if (const DriveCause cause = stop_cause(now, lasting); cause != DriveCause::kNone) return refuse(to_string(cause));
  if (now - *in.protocol.feedback > kFeedbackLate) return refuse(to_string(DriveCause::kFeedbackLate));
  if (!in.protocol.ready) return refuse("the motor controllers are not ready");
  if (in.queue_full) return refuse(to_string(DriveCause::kSendQueueFull));
  armed_ = true;
  armed_at_ = now;
  was_enabled_ = bad_command_ = false;
  command_.reset();
  status_ = {DriveLevel::kHold, DriveCause::kEnabling, status_.epoch + 1};
  return status_.epoch;
}

void Guard::stop(DriveCause cause) {
  if (!armed_ && status_.cause != DriveCause::kNotArmed) return;  // the first cause is the one that explains
  armed_ = false;
  command_.reset();
  status_.level = DriveLevel::kStop;
  status_.cause = cause;
}

DriveCause Guard::enable_cause(Time now, const Inputs& in) {
  if (in.protocol.enabled) return was_enabled_ = true, DriveCause::kNone;
  if (was_enabled_) return DriveCause::kMotorFault;
  return now - armed_at_ > kEnableTimeout ? DriveCause::kEnableFailed : DriveCause::kNone;
}

DriveCause Guard::hold_cause(Time now, const Inputs& in) const {
  if (!in.protocol.enabled) return DriveCause::kEnabling;
  if (in.queue_full) return DriveCause::kSendQueueFull;
  if (now - *in.protocol.feedback > kFeedbackLate) return DriveCause::kFeedbackLate;
  if (bad_command_) return DriveCause::kBadCommand;
  if (!command_ || now - command_at_ > kCommandTimeout) return DriveCause::kNoCommand;
  return DriveCause::kNone;
}

Order Guard::decide(Time now, const Inputs& in) {
  if (armed_) {
    DriveCause cause = stop_cause(now, in);
    if (cause == DriveCause::kNone) cause = enable_cause(now, in);
    if (cause != DriveCause::kNone) stop(cause);
  }
  if (!armed_) return {};
  Order order;
  order.enable = true;
  order.reset = !was_enabled_;
  const DriveCause cause = hold_cause(now, in);
  status_.level = cause == DriveCause::kNone ? DriveLevel::kNormal : DriveLevel::kHold;
  status_.cause = cause;
  if (cause != DriveCause::kNone) return order;
  order.halt = false;
  order.v = command_->v;
  order.w = command_->w;
  return order;
}

}  // namespace cairn::drive
