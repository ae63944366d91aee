// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/drive_task.hpp"

namespace cairn::app {

using drive::SendResult;
using scheduler::Regime;
using scheduler::Tick;

ReplayableCanLink::ReplayableCanLink(Source& source, SourceId id, const Slots& slots, drive::CanLink* bus,
                                     scheduler::Feed::Tap tap)
    : feed(
          source, id, slots.frames, [this](Time, const Error&) { ++errors_; }, std::move(tap)),
      slots_(slots),
      bus_(bus) {}

void ReplayableCanLink::begin(Tick& tick) {
  tick_ = &tick;
  sends_ = 0;
  errors_ = errors_returned_ = 0;
}

Result<Poll> ReplayableCanLink::next(Packet& packet, Duration /*timeout*/) {
  if (const Packet* fed = feed.take(*tick_)) {
    packet = *fed;
    return Poll::kPacket;
  }
  // An error of a recorded file is no fault of the bus.
  const std::int32_t errors = tick_->decide(
      slots_.errors, [this] { return errors_; }, 0);
  if (errors_returned_ >= errors) return Poll::kTimeout;
  ++errors_returned_;
  return Error{Errc::kIo, "the CAN interface does not answer"};
}

SendResult ReplayableCanLink::send(const drive::CanFrame& frame) {
  const std::int32_t bit = sends_ < 31 ? std::int32_t{1} << sends_ : 0;
  ++sends_;
  if (tick_->regime() == Regime::kLive && bus_ != nullptr) {
    const SendResult result = bus_->send(frame);
    if (result == SendResult::kQueueFull) tick_->slot(slots_.full) |= bit;
    if (result == SendResult::kDown) tick_->slot(slots_.down) |= bit;
    return result;
  }
  if ((tick_->slot(slots_.full) & bit) != 0) return SendResult::kQueueFull;
  return (tick_->slot(slots_.down) & bit) != 0 ? SendResult::kDown : SendResult::kSent;
}

Result<void> ReplayableCanLink::restart() {
  if (tick_->regime() == Regime::kLive && bus_ != nullptr) return bus_->restart();
  return {};
}

Result<void> DriveTask::attach(const drive::Config& config, Source& source, SourceId id, drive::CanLink* bus,
                               scheduler::Feed::Tap tap) {
  link_ = std::make_unique<ReplayableCanLink>(source, id, can_slots, bus, std::move(tap));
  auto drive = drive::CanDrive::create(config, *link_);
  if (!drive) return drive.error();
  drive_ = std::move(*drive);
  return {};
}

void DriveTask::tick(Tick& tick) {
  if (drive_ == nullptr || tick.regime() == Regime::kDrain) {
    while (decisions.take(tick) != nullptr) {
    }
    tick.end_of_input();
    return;
  }
  link_->begin(tick);
  obey(tick);
  command(tick.release());
  if (const auto state = drive_->tick(tick.release()); state && *state != nullptr) state_ = **state;
  publish(tick);
  publish_wheels(tick);
  if (link_->feed.ended()) tick.end_of_input();
}

void DriveTask::obey(Tick& tick) {
  bool arm = false;
  while (const safety::FailsafeDecision* decision = decisions.take(tick)) {
    decision_ = *decision;
    arm = arm || decision_.arm;
  }
  const Time now = tick.release();
  if (arm) {
    const auto epoch = drive_->arm(now);
    epoch_ = epoch ? std::optional(*epoch) : std::nullopt;
  } else if (decision_.mode == safety::Mode::kStop && !decision_.arm && drive_->status().level != DriveLevel::kStop) {
    drive_->stop(decision_.cause == safety::Fault::kEStopOpen ? DriveCause::kEmergencyStop : DriveCause::kRequested,
                 now);
  }
}

void DriveTask::command(Time now) {
  if (!planner_ || !epoch_) return;
  auto wanted = planner_(now);
  if (!wanted) return;
  wanted->epoch = *epoch_;
  (void)drive_->command(safety::limited(*wanted, decision_), now);  // the drive's status says what became of it
}

void DriveTask::publish(Tick& tick) {
  DriveNews news{drive_->status(), published_.feedback};
  if (state_ && state_->stamp != published_.feedback.last)
    news.feedback = {state_->stamp, published_.feedback.count + 1};
  const bool same = news.status.level == published_.status.level && news.status.cause == published_.status.cause &&
                    news.status.epoch == published_.status.epoch && news.feedback.count == published_.feedback.count;
  if (same) return;
  DriveNews* out = status.back(tick);
  if (out == nullptr) return;  // with the next tick
  *out = published_ = news;
  status.push(tick);
}

void DriveTask::publish_wheels(Tick& tick) {
  if (!state_ || state_->stamp == published_wheels_) return;
  published_wheels_ = state_->stamp;
  DriveState* out = wheels.back(tick);
  if (out == nullptr) return;
  *out = *state_;
  wheels.push(tick);
}

}  // namespace cairn::app
