// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>

#include "drivers/gpio/estop.hpp"
#include "drivers/gpio/gpio_lines.hpp"
#include "drivers/gpio/pulses.hpp"
#include "hal/spsc_queue.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/scheduler/feed.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// The safety task reads the e-stop, knows which sensor was heard last, and decides what the robot may do. It allocates
/// nothing, locks nothing and never waits.
class SafetyTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  const std::size_t edges_slot = take_slots();  ///< edges of the e-stop taken
  const std::size_t level_slot = take_slots();  ///< the e-stop's level, where the edges did not tell it
  scheduler::InputPort<SensorsSeen> sensors{*this, "sensors"};
  scheduler::InputPort<DriveNews> drive{*this, "drive"};
  scheduler::OutputPort<safety::FailsafeDecision> decisions{*this, "decisions"};
  scheduler::InputPort<RearmRequest> rearms{*this, "rearms"};
  const std::size_t faults_slot = take_slots();  ///< faults that only the machine shows
  scheduler::InputPort<OdometryNews> odometry{*this, "odometry"};
  scheduler::OutputPort<LineEdge> lines{*this, "lines"};  ///< rising edges of the trigger and of the pulse per second

  /// What changed, for a task that may lock and allocate.
  struct Change {
    Time at{};
    safety::Mode mode{};
    std::optional<safety::Fault> cause;
    safety::FaultSet raised, ended, active;
    std::uint32_t epoch = 0;
  };
  static constexpr std::size_t kMaxChanges = 1024;  ///< that wait to be read

  SafetyTask(const safety::FailsafeConfig& config, const safety::Fitted& fitted)
      : failsafe_(config, fitted), has_estop_(fitted.estop) {}
  /// The GPIO lines: the e-stop is watched, if it is fitted, and the cameras' trigger is pulsed. `source` and `chip`
  /// (null in a replay) must outlive the task.
  void use_lines(const gpio::Config& config, Source& source, SourceId id, gpio::GpioLines* chip,
                 scheduler::Feed::Tap tap);

  void tick(scheduler::Tick& tick) override;

  /// Any one thread: faults that the machine shows and the data does not, such as a hung task.
  void report(safety::FaultSet faults) { faults_.store(static_cast<std::int32_t>(faults.bits())); }

  /// To be read by one other thread.
  [[nodiscard]] SpscQueue<Change>& changes() { return changes_; }
  /// Of the task's thread, or of a run that has ended.
  [[nodiscard]] const safety::FailsafeDecision& decision() const { return failsafe_.decision(); }
  [[nodiscard]] Time first_arrival() { return edges_ ? edges_->first_arrival() : Time::max(); }
  [[nodiscard]] std::uint64_t lost_changes() const { return lost_changes_; }
  [[nodiscard]] bool input_ended() const { return !edges_ || edges_->ended(); }

 private:
  void read_news(scheduler::Tick& tick);
  void pulse(Time now);
  void read_lines(scheduler::Tick& tick);
  void read_edge(const Packet& packet, scheduler::Tick& tick);
  void judge_estop(Time now);
  void read_level(scheduler::Tick& tick);
  void publish(const safety::FailsafeDecision& before, scheduler::Tick& tick);

  safety::Failsafe failsafe_;
  bool has_estop_;
  safety::FailsafeInputs inputs_;
  safety::FaultSet sensor_faults_, odometry_faults_;
  Time arming_until_{};
  std::optional<gpio::EStop> estop_;
  std::optional<scheduler::Feed> edges_;
  gpio::GpioLines* chip_ = nullptr;
  std::optional<gpio::Trigger> trigger_;
  std::int32_t closed_ = 0;  // as the edges say: 0 nothing yet, 1 open, 2 closed
  std::atomic<std::int32_t> faults_{0};
  SpscQueue<Change> changes_{kMaxChanges};
  RelaxedCounter lost_changes_;
};

}  // namespace cairn::app
