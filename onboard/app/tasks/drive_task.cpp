// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/drive_task.hpp"

#include <algorithm>
#include <utility>

#include "drivers/drive/chassis/differential.hpp"

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
  max_speed_m_s_ = config.max_speed_m_s;
  max_yaw_rate_rad_s_ = config.max_yaw_rate_rad_s;
  return {};
}

// Errors of the socket are its clients' own.
DriveTask::Commands::Commands(Source& source, SourceId id, std::size_t slot, clients::AnswerPort* port,
                              scheduler::Feed::Tap tap, const Commander::Abilities& abilities, bool lasting)
    : feed(
          source, id, slot, [](Time, const Error&) {}, std::move(tap)),
      commander(abilities),
      answers(port),
      awaited(lasting) {}

void DriveTask::obey_commands(Source& source, SourceId id, clients::AnswerPort* answers, scheduler::Feed::Tap tap,
                              bool moves) {
  commands_ = std::make_unique<Commands>(
      source, id, commands_slot, answers, std::move(tap),
      Commander::Abilities{.drives = moves && drive_ != nullptr, .in_team = places.connected()}, moves);
  set_planner([this](Time now) { return commands_->commander.wanted(now); });
}

Time DriveTask::first_arrival() {
  const Time frames = link_ ? link_->feed.first_arrival() : Time::max();
  return std::min(frames, commands_ ? commands_->feed.first_arrival() : Time::max());
}

std::uint64_t DriveTask::missing_packets() const {
  return (link_ ? link_->feed.missing() : 0) + (commands_ ? commands_->feed.missing() : 0);
}

void DriveTask::tick(Tick& tick) {
  if (drive_ == nullptr || tick.regime() == Regime::kDrain) return tick_without_drive(tick);
  link_->begin(tick);
  obey(tick);
  if (commands_) obey_commander(tick);
  command(tick.release());
  if (const auto state = drive_->tick(tick.release()); state && *state != nullptr) state_ = **state;
  if (commands_) answer(tick.release());
  if (published_to_ != nullptr) published_to_->publish(drive_->status());
  publish(tick);
  publish_wheels(tick);
  if (link_->feed.ended() && (!commands_ || commands_->ended())) tick.end_of_input();
}

/// A robot without a drive can be told where it is.
void DriveTask::tick_without_drive(Tick& tick) {
  while (const safety::FailsafeDecision* decision = decisions.take(tick)) decision_ = *decision;
  const bool heard = commands_ && tick.regime() != Regime::kDrain;
  if (heard) {
    obey_commander(tick);
    answer(tick.release());
  }
  if (!heard || commands_->ended()) tick.end_of_input();
}

template <class T>
void DriveTask::hand_on(scheduler::OutputPort<T>& port, const T& value, Tick& tick) {
  if (T* out = port.back(tick)) {
    *out = value;
    port.push(tick);
  }
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

/// A stop is obeyed at once, without the safety task: that hears of it from the drive.
void DriveTask::obey_commander(Tick& tick) {
  Commander& commander = commands_->commander;
  while (const Packet* packet = commands_->feed.take(tick)) commander.take(*packet, situation(tick.release()));
  const Commander::Orders orders = commander.take_orders();
  if (orders.stop) drive_->stop(DriveCause::kRequested, tick.release());
  if (orders.arm) hand_on(rearms, RearmRequest{.epoch = *orders.arm}, tick);
  if (orders.place) hand_on(places, *orders.place, tick);
}

void DriveTask::answer(Time now) {
  Commander& commander = commands_->commander;
  commander.conclude(situation(now), told_);
  if (commands_->answers != nullptr)
    for (const Commander::Reply& reply : commander.replies())
      (void)commands_->answers->answer(reply.client, reply.answer);
  commander.forget_replies();
}

void DriveTask::command(Time now) {
  told_ = {};
  if (!planner_ || !epoch_) return;
  auto wanted = planner_(now);
  if (!wanted) return;
  wanted->epoch = *epoch_;
  const DriveCommand allowed = safety::limited(*wanted, decision_);
  (void)drive_->command(allowed, now);  // the drive's status says what became of it
  const drive::Velocity told = drive::limited({allowed.v, allowed.w}, max_speed_m_s_, max_yaw_rate_rad_s_);
  told_ = {.v = told.v, .w = told.w};
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

void DriveTask::tell_clients() {
  if (outlets_ == nullptr || !outlets_->wheels_wanted.load(std::memory_order_relaxed)) return;
  if (WheelNews* news = outlets_->wheels.back()) {
    *news = {*state_, drive_->motions()};
    outlets_->wheels.push();
  }
}

void DriveTask::publish_wheels(Tick& tick) {
  if (!state_ || state_->stamp == published_wheels_) return;
  published_wheels_ = state_->stamp;
  tell_clients();
  DriveState* out = wheels.back(tick);
  if (out == nullptr) return;
  *out = *state_;
  wheels.push(tick);
}

}  // namespace cairn::app
