// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/failsafe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::safety {
namespace {

Duration milliseconds(double ms) { return from_seconds(1e-3 * ms); }

FaultPolicy policy_of(const FailsafeConfig& config) {
  FaultPolicy policy;
  for (const FaultRow& row : fault_table()) {
    const Mode mode = config.mode(row.fault);
    policy.degrade.set(row.fault, mode == Mode::kDegraded);
    policy.hold.set(row.fault, mode == Mode::kHold);
    policy.stop.set(row.fault, mode == Mode::kStop);
  }
  return policy;
}

double speed_cap(Mode mode, double degraded_m_s) {
  if (mode == Mode::kNormal) return std::numeric_limits<double>::infinity();
  return mode == Mode::kDegraded ? degraded_m_s : 0.0;
}

}  // namespace

Failsafe::Failsafe(const FailsafeConfig& c, const Fitted& fitted)
    : fitted_(fitted), policy_(policy_of(c)), degraded_speed_m_s_(c.degraded_speed_m_s) {
  const auto recover = static_cast<std::uint64_t>(c.lidar_recover_scans);
  limits_ = {{{milliseconds(c.lidar_late_ms), milliseconds(c.lidar_silent_ms), Fault::kLidarLate, Fault::kLidarSilent,
               recover},
              {Duration::max(), milliseconds(c.camera_silent_ms), {}, Fault::kCameraSilent, 1},
              {Duration::max(), milliseconds(c.thermal_silent_ms), {}, Fault::kThermalSilent, 1},
              {Duration::max(), milliseconds(c.depth_silent_ms), {}, Fault::kDepthSilent, 1},
              {milliseconds(c.feedback_late_ms), milliseconds(c.feedback_lost_ms), Fault::kFeedbackLate,
               Fault::kFeedbackLost, 1}}};
  if (!fitted.drive) latch_.state = Latch::State::kRunning;
  decide({}, {});
}

FaultSet Failsafe::watch(const Limits& limits, const Seen& seen, Watch& watch) const {
  // Only a new piece is a sign of life, and a stamp from the future makes it no younger than now.
  if (seen.count != watch.count) watch.at = std::clamp(seen.last, watch.at, now_);
  watch.count = seen.count;
  const Duration age = now_ - watch.at;
  FaultSet found;
  if (limits.when_late && age > limits.late) found.set(*limits.when_late);
  if (limits.when_lost && age > limits.lost) found.set(*limits.when_lost);
  if (!found.empty()) watch.missing_count = watch.count;
  // The first good piece ends the worse of two, the last of those asked for ends both.
  const bool recovered = watch.count - watch.missing_count >= limits.recover;
  if (found.empty() && !recovered && !watch.active.empty() && limits.when_late) found.set(*limits.when_late);
  watch.active = found;
  return found;
}

FaultSet Failsafe::missing(const FailsafeInputs& in) {
  FaultSet all;
  for (std::size_t i = 0; i < kWatched; ++i) {
    if (!started_) watch_[i].at = now_;  // what never came is missing since the first step
    if (fitted_.watched[i]) all = all | watch(limits_[i], in.seen[i], watch_[i]);
  }
  started_ = true;
  return all;
}

FaultSet Failsafe::of_guards(const FailsafeInputs& in) const {
  FaultSet active;
  if (fitted_.drive && in.drive.level == DriveLevel::kHold)
    active.set(fault_of(in.drive.cause).value_or(Fault::kDriveNotReady));
  if (fitted_.estop && in.estop.lost) active.set(Fault::kEStopLost);
  if (fitted_.estop && !in.estop.lost && !in.estop.released) active.set(Fault::kEStopOpen);
  return active;
}

FaultSet Failsafe::latched_guards(const FailsafeInputs& in) const {
  FaultSet latched;
  if (fitted_.drive && in.drive.level == DriveLevel::kStop)
    if (const auto fault = fault_of(in.drive.cause)) latched.set(*fault);
  if (fitted_.estop && in.estop.latched) latched.set(Fault::kEStopOpen);
  return latched;
}

void Failsafe::decide(FaultSet active, FaultSet latched) {
  decision_.raised = active - decision_.active;
  decision_.ended = decision_.active - active;
  decision_.active = active;
  decision_.blocking = active & policy_.stop;
  const bool stopped = latch_.state != Latch::State::kRunning;
  const bool was_stopped = decision_.mode == Mode::kStop;
  decision_.mode = stopped ? Mode::kStop : policy_.demanded_by(active);
  const auto worst = policy_.worst_of(active);
  if (!stopped)
    decision_.cause = worst;
  else if (!was_stopped)
    decision_.cause = worst ? worst : policy_.worst_of(latched);
  decision_.max_speed_m_s = speed_cap(decision_.mode, degraded_speed_m_s_);
  decision_.epoch = latch_.epoch;
}

const FailsafeDecision& Failsafe::step(const FailsafeInputs& in) {
  now_ = started_ ? std::max(now_, in.now) : in.now;
  const FaultSet active = in.faults | missing(in) | of_guards(in), latched = latched_guards(in);
  const bool stops = policy_.demanded_by(active) == Mode::kStop;
  const bool guard = (fitted_.drive && in.drive.level == DriveLevel::kStop) || (fitted_.estop && in.estop.latched);
  const Latch::State before = latch_.state;
  latch_ = latch_.next({stops, guard, in.rearm});
  decide(active, latched);
  decision_.arm = before == Latch::State::kStopped && latch_.state == Latch::State::kArming;
  return decision_;
}

std::optional<Fault> fault_of(DriveCause cause) {
  switch (cause) {
    case DriveCause::kFeedbackLate:
      return Fault::kFeedbackLate;
    case DriveCause::kFeedbackLost:
      return Fault::kFeedbackLost;
    case DriveCause::kSendQueueFull:
      return Fault::kSendQueueFull;
    case DriveCause::kEnabling:
    case DriveCause::kNoCommand:
    case DriveCause::kBadCommand:
      return Fault::kDriveNotReady;
    case DriveCause::kEmergencyStop:
      return Fault::kEStopOpen;
    case DriveCause::kErrorPassive:
    case DriveCause::kBusOff:
      return Fault::kBusFailing;
    case DriveCause::kLinkDown:
      return Fault::kLinkDown;
    case DriveCause::kMotorFault:
    case DriveCause::kEnableFailed:
      return Fault::kMotorFault;
    case DriveCause::kMotorReset:
      return Fault::kMotorReset;
    case DriveCause::kNone:
    case DriveCause::kNotArmed:
    case DriveCause::kRequested:
      break;
  }
  return std::nullopt;
}

DriveCommand limited(const DriveCommand& command, const FailsafeDecision& decision) {
  DriveCommand out = command;
  // A speed that is no number fails the comparison and is left for the drive to refuse.
  const double share =
      std::abs(command.v) > decision.max_speed_m_s ? decision.max_speed_m_s / std::abs(command.v) : 1.0;
  const bool still = decision.mode >= Mode::kHold;
  out.v = still ? 0.0 : share * command.v;
  out.w = still ? 0.0 : share * command.w;
  return out;
}

}  // namespace cairn::safety
