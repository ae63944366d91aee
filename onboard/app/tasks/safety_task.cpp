// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/safety_task.hpp"

namespace cairn::app {
namespace {

using scheduler::Tick;

// The drive hears of its arming with its next tick, and this task hears of the drive with the tick after: 4 ms at
// 500 Hz. Late ticks take longer.
constexpr Duration kArming = std::chrono::milliseconds(20);
// What the level slot of a tick may hold. 0: as the edges said.
constexpr std::int32_t kOpen = 1, kClosed = 2, kLost = 3;

bool same(const safety::FailsafeDecision& a, const safety::FailsafeDecision& b) {
  return a.mode == b.mode && a.cause == b.cause && a.active == b.active && a.epoch == b.epoch && !a.arm && !b.arm;
}

}  // namespace

void SafetyTask::use_lines(const gpio::Config& config, Source& source, SourceId id, gpio::GpioLines* chip,
                           scheduler::Feed::Tap tap) {
  if (has_estop_) estop_.emplace(config);
  if (!config.trigger_line.empty()) trigger_.emplace(config);
  // Reading the level shows the loss of the line, too. This thread needs no words about it.
  edges_.emplace(
      source, id, edges_slot, [](Time, const Error&) {}, std::move(tap));
  chip_ = chip;
}

void SafetyTask::tick(Tick& tick) {
  if (tick.regime() == scheduler::Regime::kDrain) return;  // the run is over: nothing is late any more
  inputs_.now = tick.release();
  read_news(tick);
  if (tick.release() < arming_until_) inputs_.drive.level = DriveLevel::kHold;
  if (chip_ != nullptr && trigger_) pulse(tick.release());
  if (edges_) read_lines(tick);
  const std::int32_t reported = tick.decide(
      faults_slot, [this] { return faults_.load(); }, 0);
  inputs_.faults = safety::FaultSet(static_cast<std::uint32_t>(reported)) | sensor_faults_ | odometry_faults_;

  const safety::FailsafeDecision before = failsafe_.decision();
  if (failsafe_.step(inputs_).arm) {
    arming_until_ = tick.release() + kArming;
    if (estop_) (void)estop_->rearm(tick.release());
  }
  if (!same(before, failsafe_.decision())) publish(before, tick);
  if (input_ended()) tick.end_of_input();
}

void SafetyTask::read_news(Tick& tick) {
  while (const SensorsSeen* news = sensors.take(tick)) {
    for (std::size_t i = 0; i < safety::kWatched; ++i)
      if (i != static_cast<std::size_t>(safety::Watched::kFeedback)) inputs_.seen[i] = news->seen[i];
    sensor_faults_ = news->faults;
  }
  while (const DriveNews* news = drive.take(tick)) {
    inputs_.drive = news->status;
    arming_until_ = {};
    inputs_.seen[static_cast<std::size_t>(safety::Watched::kFeedback)] = news->feedback;
  }
  inputs_.rearm.reset();
  while (const RearmRequest* request = rearms.take(tick)) inputs_.rearm = request->epoch;
  while (const OdometryNews* news = odometry.take(tick)) odometry_faults_.set(safety::Fault::kOdometryLost, news->lost);
}

/// A line that cannot be set shows in pictures that do not come.
void SafetyTask::pulse(Time now) {
  if (const auto level = trigger_->step(now)) (void)chip_->pulse(gpio::Line::kTrigger, *level);
}

void SafetyTask::read_lines(Tick& tick) {
  while (const Packet* packet = edges_->take(tick)) read_edge(*packet, tick);
  if (!estop_) return;
  read_level(tick);
  judge_estop(tick.release());
}

void SafetyTask::read_edge(const Packet& packet, Tick& tick) {
  const auto event = gpio::decode_event(packet);
  if (!event) return;
  if (event->line == gpio::Line::kEStop) {
    if (!estop_) return;
    closed_ = event->level ? kClosed : kOpen;
    estop_->edge(packet.arrival, event->level, event->sequence);
  } else if (event->level) {
    LineEdge* out = lines.back(tick);
    if (out == nullptr) return;
    *out = {event->line, packet.arrival};
    lines.push(tick);
  }
}

void SafetyTask::judge_estop(Time now) {
  inputs_.estop.latched = estop_->stopped(now);
  inputs_.estop.released = estop_->released(now);
  const auto cause = estop_->cause();
  // Once the contact is seen closed again, the loss is history: it must not stand in the way of a request.
  inputs_.estop.lost = inputs_.estop.latched && !inputs_.estop.released &&
                       (cause == gpio::EStop::Cause::kLineLost || cause == gpio::EStop::Cause::kSilent);
}

void SafetyTask::read_level(Tick& tick) {
  const auto look = [this] {
    if (chip_ == nullptr) return 0;
    const auto level = chip_->level(gpio::Line::kEStop);
    const std::int32_t now = !level ? kLost : *level ? kClosed : kOpen;
    return now == closed_ ? 0 : now;
  };
  const std::int32_t told = tick.decide(level_slot, look, 0);
  const std::int32_t level = told == 0 ? closed_ : told;
  if (level == kLost)
    estop_->lost(tick.release());
  else if (level != 0)
    estop_->level(tick.release(), level == kClosed);
}

void SafetyTask::publish(const safety::FailsafeDecision& before, Tick& tick) {
  const safety::FailsafeDecision& now = failsafe_.decision();
  if (safety::FailsafeDecision* out = decisions.back(tick)) {
    *out = now;
    decisions.push(tick);
  }
  if (before.mode == now.mode && now.raised.empty() && now.ended.empty()) return;
  if (Change* change = changes_.back()) {
    *change = {tick.release(), now.mode, now.cause, now.raised, now.ended, now.active, now.epoch};
    changes_.push();
  } else {
    ++lost_changes_;
  }
}

}  // namespace cairn::app
