// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/drive_task.hpp"

namespace cairn {

using drive::SendResult;
using scheduler::Regime;
using scheduler::Tick;

FedLink::FedLink(Source& source, SourceId id, drive::CanLink* bus, scheduler::Feed::Tap tap)
    : feed(
          source, id, kFramesSlot, [this](Time, const Error&) { ++errors_; }, std::move(tap)),
      bus_(bus) {}

void FedLink::begin(Tick& tick) {
  tick_ = &tick;
  sends_ = 0;
  errors_ = errors_told_ = 0;
}

Result<Poll> FedLink::next(Packet& packet, Duration /*timeout*/) {
  if (const Packet* fed = feed.take(*tick_)) {
    packet = *fed;
    return Poll::kPacket;
  }
  // What a recorded file complains of is no fault of the bus.
  const std::int32_t errors = tick_->decide(
      kErrorSlot, [this] { return errors_; }, 0);
  if (errors_told_ >= errors) return Poll::kTimeout;
  ++errors_told_;
  return Error{Errc::kIo, "the CAN interface does not answer"};
}

SendResult FedLink::send(const drive::CanFrame& frame) {
  const std::int32_t bit = sends_ < 31 ? std::int32_t{1} << sends_ : 0;
  ++sends_;
  if (tick_->regime() == Regime::kLive && bus_ != nullptr) {
    const SendResult result = bus_->send(frame);
    if (result == SendResult::kQueueFull) tick_->slot(kFullSlot) |= bit;
    if (result == SendResult::kDown) tick_->slot(kDownSlot) |= bit;
    return result;
  }
  if ((tick_->slot(kFullSlot) & bit) != 0) return SendResult::kQueueFull;
  return (tick_->slot(kDownSlot) & bit) != 0 ? SendResult::kDown : SendResult::kSent;
}

Result<void> FedLink::restart() {
  if (tick_->regime() == Regime::kLive && bus_ != nullptr) return bus_->restart();
  return {};
}

Result<void> DriveTask::attach(const drive::Config& config, Source& source, SourceId id, drive::CanLink* bus,
                               scheduler::Feed::Tap tap) {
  link_ = std::make_unique<FedLink>(source, id, bus, std::move(tap));
  auto drive = drive::CanDrive::create(config, *link_);
  if (!drive) return drive.error();
  drive_ = std::move(*drive);
  return {};
}

void DriveTask::tick(Tick& tick) {
  if (drive_ == nullptr || tick.regime() == Regime::kDrain) {
    while (decisions_.take(tick) != nullptr) {
    }
    tick.end_of_input();
    return;
  }
  link_->begin(tick);
  obey(tick);
  command(tick.release());
  if (const auto state = drive_->tick(tick.release()); state && *state != nullptr) state_ = **state;
  tell(tick);
  if (link_->feed.ended()) tick.end_of_input();
}

void DriveTask::obey(Tick& tick) {
  bool arm = false;
  while (const FailsafeDecision* decision = decisions_.take(tick)) {
    decision_ = *decision;
    arm = arm || decision_.arm;
  }
  const Time now = tick.release();
  if (arm) {
    const auto epoch = drive_->arm(now);
    epoch_ = epoch ? std::optional(*epoch) : std::nullopt;
  } else if (decision_.mode == Mode::kStop && !decision_.arm && drive_->status().level != DriveLevel::kStop) {
    drive_->stop(decision_.cause == Fault::kEStopOpen ? DriveCause::kEmergencyStop : DriveCause::kRequested, now);
  }
}

void DriveTask::command(Time now) {
  if (!planner_ || !epoch_) return;
  auto wanted = planner_(now);
  if (!wanted) return;
  wanted->epoch = *epoch_;
  (void)drive_->command(limited(*wanted, decision_), now);  // the drive's status says what became of it
}

void DriveTask::tell(Tick& tick) {
  DriveNews news{drive_->status(), told_.feedback};
  if (state_ && state_->stamp != told_.feedback.last) news.feedback = {state_->stamp, told_.feedback.count + 1};
  const bool same = news.status.level == told_.status.level && news.status.cause == told_.status.cause &&
                    news.status.epoch == told_.status.epoch && news.feedback.count == told_.feedback.count;
  if (same) return;
  DriveNews* out = news_.back(tick);
  if (out == nullptr) return;  // told with the next tick
  *out = told_ = news;
  news_.push(tick);
}

}  // namespace cairn
